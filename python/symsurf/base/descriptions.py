"""The descriptions of methods and operations in words, and functions made from them."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any, TypeVar, cast

from .._core import Parameter

_TYPES = {
    "boolean": "bool",
    "integer": "int",
    "real": "float",
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
        annotation=_TYPES.get(parameter.type) or f"Literal[{str(parameter.choices)[1:-1]}]",
    )


Function = TypeVar("Function", bound=Callable[..., Any])


def renamed(**names: str) -> Callable[[Function], Function]:
    """Of a function whose arguments had other names: these are still taken by keyword."""

    def decorate(function: Function) -> Function:
        @wraps(function)
        def taking(*given: Any, **options: Any) -> Any:
            for old, new in names.items():
                if old in options and new not in options:
                    options[new] = options.pop(old)
            return function(*given, **options)

        return cast(Function, taking)

    return decorate


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
