"""``detect_<method>`` for every method there is, made from the methods' own descriptions."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from typing import Any

from ._core import Method, Parameter, methods
from .descriptions import allowed
from .detection import detect
from .result import Result

_TYPES = {
    "boolean": "bool",
    "integer": "int",
    "real": "float",
    "choice": "str",
    "direction": "ArrayLike",
    "position": "ArrayLike",
}

# What every detector takes beside its method's parameters.
_OPTIONS = {
    name: parameter
    for name, parameter in inspect.signature(detect).parameters.items()
    if parameter.kind is inspect.Parameter.KEYWORD_ONLY
}


def _keyword(parameter: Parameter) -> inspect.Parameter:
    default = parameter.default
    if parameter.type in ("direction", "position"):
        default = tuple(default.tolist())
    return inspect.Parameter(
        parameter.name,
        inspect.Parameter.KEYWORD_ONLY,
        default=default,
        annotation=_TYPES[parameter.type],
    )


def _signature(method: Method) -> inspect.Signature:
    points = inspect.signature(detect).parameters["points"]
    own = [_keyword(parameter) for parameter in method.parameters]
    return inspect.Signature([points, *own, *_OPTIONS.values()], return_annotation="Result")


def _paragraph(text: str, indent: int = 0) -> str:
    first = " " * indent
    return textwrap.fill(text, 96, initial_indent=first, subsequent_indent=first + "    ")


def _docstring(method: Method) -> str:
    lines = [textwrap.fill(method.summary, 96), "", "Args:"]
    least = f"at least {method.minimum_points} finite points"
    lines.append(f"    points: {least}, or a mesh, as ``detect`` takes them.")
    for parameter in method.parameters:
        text = f"{parameter.name}: {parameter.doc} Allowed: {allowed(parameter)}."
        lines.append(_paragraph(text, 4))
    lines.append(_paragraph(f"{', '.join(_OPTIONS)}: as for ``detect``.", 4))
    return "\n".join(lines)


def _detector(method: Method) -> Callable[..., Result]:
    signature = _signature(method)

    def detector(points: Any, **options: Any) -> Result:
        return detect(points, method.name, **options)

    detector.__name__ = detector.__qualname__ = f"detect_{method.name}"
    detector.__module__ = __name__
    detector.__doc__ = _docstring(method)
    detector.__signature__ = signature  # type: ignore[attr-defined]
    detector.__annotations__ = {
        name: parameter.annotation for name, parameter in signature.parameters.items()
    } | {"return": signature.return_annotation}
    return detector


__all__ = [f"detect_{name}" for name in methods()]
globals().update({f"detect_{method.name}": _detector(method) for method in methods().values()})
