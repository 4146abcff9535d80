"""The options of generators, kinds of damage, operations and analyses, made from their descriptions."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from .._core import Analysis, Damage, Generator, Operation, Parameter
from ..base.plain import shown
from .values import value_from

Description: TypeAlias = Generator | Damage | Operation | Analysis


def add_kinds(
    parser: argparse.ArgumentParser,
    kinds: Mapping[str, Description],
    add_more: Callable[[argparse.ArgumentParser, Any], None],
) -> Any:
    """A sub-command for each kind, with one option for each of its parameters; gives what argparse
    adds further ones to."""
    commands = parser.add_subparsers(required=True, metavar="KIND")
    for name, kind in kinds.items():
        sub = commands.add_parser(
            name, help=kind.title, description=kind.summary, allow_abbrev=False
        )
        add_more(sub, kind)
        add_parameters(sub, kind)
    return commands


def add_parameters(parser: argparse.ArgumentParser, kind: Description) -> None:
    """One option for each parameter of the kind; a boolean one without a value is true."""
    parser.set_defaults(kind=kind)
    group = parser.add_argument_group("parameters")
    for parameter in kind.parameters:
        about = f"{parameter.doc} {parameter.allowed}, default {shown(parameter.default)}"
        bare: dict[str, Any] = (
            {"nargs": "?", "const": "true"} if parameter.type == "boolean" else {}
        )
        group.add_argument(
            *sorted({f"--{parameter.name.replace('_', '-')}", f"--{parameter.name}"}),
            dest=f"value:{parameter.name}",
            default=argparse.SUPPRESS,
            metavar=metavar_of(parameter),
            help=about.replace("%", "%%"),
            **bare,
        )


def metavar_of(parameter: Parameter) -> str:
    if parameter.type == "choice":
        return f"{{{','.join(parameter.choices)}}}"
    return "X,Y,Z" if parameter.type in ("direction", "position") else "VALUE"


def given_values(arguments: argparse.Namespace) -> dict[str, Any]:
    """The parameters on the command line, in the types of their descriptions."""
    given = vars(arguments)
    return {
        parameter.name: value_from(given[f"value:{parameter.name}"], parameter)
        for parameter in arguments.kind.parameters
        if f"value:{parameter.name}" in given
    }
