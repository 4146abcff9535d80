"""The options of the methods, made from their descriptions."""

from __future__ import annotations

import argparse
from typing import Any

from .._core import Method, Parameter
from .._core import methods as all_methods
from ..base.plain import shown
from .described_options import metavar_of
from .terminal import Parser
from .values import value_from

_PREFIX = "parameter:"


def add_method_options(parser: Parser) -> None:
    """One option for each parameter that any method has; help shows those of the chosen method."""
    group = parser.add_argument_group(
        "parameters of the method", "of another method: symsurf detect --method M --help"
    )
    for name, owners in _owners().items():
        action = group.add_argument(
            *sorted({f"--{name.replace('_', '-')}", f"--{name}"}),
            dest=_PREFIX + name,
            default=argparse.SUPPRESS,
            metavar=metavar_of(owners[0][1]),
            help="; ".join(_helps(owners)),
        )
        parser.help_of_methods[action] = {
            method.name: _text(parameter) for method, parameter in owners
        }


def given_parameters(arguments: argparse.Namespace) -> dict[str, Any]:
    """The parameters on the command line, in the types of the chosen method's description."""
    method = all_methods().get(arguments.method)
    described = {parameter.name: parameter for parameter in method.parameters} if method else {}
    texts = {
        name[len(_PREFIX) :]: text
        for name, text in vars(arguments).items()
        if name.startswith(_PREFIX)
    }
    return {
        name: value_from(text, described[name]) if name in described else text
        for name, text in texts.items()
    }


def _owners() -> dict[str, list[tuple[Method, Parameter]]]:
    owners: dict[str, list[tuple[Method, Parameter]]] = {}
    for method in all_methods().values():
        for parameter in method.parameters:
            owners.setdefault(parameter.name, []).append((method, parameter))
    return owners


def _text(parameter: Parameter) -> str:
    text = f"{parameter.doc} {parameter.allowed}, default {shown(parameter.default)}"
    return text.replace("%", "%%")


def _helps(owners: list[tuple[Method, Parameter]]) -> list[str]:
    texts: dict[str, list[str]] = {}
    for method, parameter in owners:
        texts.setdefault(_text(parameter), []).append(method.name)
    return [f"({', '.join(names)}) {text}" for text, names in texts.items()]
