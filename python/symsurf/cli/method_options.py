"""The options of the methods, made from their descriptions."""

from __future__ import annotations

import argparse
from typing import Any

from .._core import Method, Parameter
from .._core import methods as all_methods
from .values import shown, value_from

_PREFIX = "parameter:"


def add_method_options(parser: argparse.ArgumentParser) -> None:
    """One option for each parameter that any method has."""
    group = parser.add_argument_group("parameters of the methods")
    for name, owners in _owners().items():
        group.add_argument(
            *sorted({f"--{name.replace('_', '-')}", f"--{name}"}),
            dest=_PREFIX + name,
            default=argparse.SUPPRESS,
            metavar=_metavar(owners[0][1]),
            help="; ".join(_helps(owners)).replace("%", "%%"),
        )


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


def _helps(owners: list[tuple[Method, Parameter]]) -> list[str]:
    texts: dict[str, list[str]] = {}
    for method, parameter in owners:
        text = f"{parameter.doc} {parameter.allowed}, default {shown(parameter.default)}"
        texts.setdefault(text, []).append(method.name)
    return [f"({', '.join(names)}) {text}" for text, names in texts.items()]


def _metavar(parameter: Parameter) -> str:
    return "X,Y,Z" if parameter.type in ("direction", "position") else "VALUE"
