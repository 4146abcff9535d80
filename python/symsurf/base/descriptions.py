"""The descriptions of methods and operations in words, and functions made from them."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterable
from typing import Any

from .._core import Parameter

_TYPES = {
    "boolean": "bool",
    "integer": "int",
    "real": "float",
    "choice": "str",
    "direction": "ArrayLike",
    "position": "ArrayLike",
}


def keyword(parameter: Parameter) -> inspect.Parameter:
    """The parameter as a keyword argument."""
    default = parameter.default
    if parameter.type in ("direction", "position"):
        default = tuple(default.tolist())
    return inspect.Parameter(
        parameter.name,
        inspect.Parameter.KEYWORD_ONLY,
        default=default,
        annotation=_TYPES[parameter.type],
    )


def argument_text(text: str) -> str:
    """A paragraph under "Args:"."""
    return textwrap.fill(text, 96, initial_indent=" " * 4, subsequent_indent=" " * 8)


def parameter_texts(parameters: Iterable[Parameter]) -> list[str]:
    """A paragraph under "Args:" for each."""
    return [
        argument_text(f"{each.name}: {each.doc} Allowed: {each.allowed}.") for each in parameters
    ]


def name_function(
    function: Callable[..., Any],
    name: str,
    module: str,
    signature: inspect.Signature,
    lines: Iterable[str],
) -> Callable[..., Any]:
    """The function with the name, the signature and the documentation that a description gives it."""
    function.__name__ = function.__qualname__ = name
    function.__module__ = module
    function.__doc__ = "\n".join(lines)
    function.__signature__ = signature  # type: ignore[attr-defined]
    function.__annotations__ = {
        each: parameter.annotation for each, parameter in signature.parameters.items()
    } | {"return": signature.return_annotation}
    return function
