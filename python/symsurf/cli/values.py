"""Values of parameters as they are written on the command line."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

from .._core import Parameter

_NUMBER = re.compile(r"-\.?\d")


def value_from(text: str, parameter: Parameter) -> Any:
    """The value in the parameter's type; a text that is none is left for the core to refuse."""
    try:
        return _CONVERSIONS[parameter.type](text)
    except (ValueError, KeyError):
        return text


def whole(text: str) -> Any:
    """The whole number; a text that is none is left for the core to refuse."""
    try:
        return int(text)
    except ValueError:
        return text


def number(text: str) -> Any:
    """The number; a text that is none is left for what takes it to refuse."""
    try:
        return float(text)
    except ValueError:
        return text


def duration(seconds: float) -> str:
    """In the unit that a reader would say it in, to three digits."""
    if seconds < 1:
        return f"{1000 * seconds:.3g} ms"
    return f"{seconds:.3g} s" if seconds < 100 else f"{seconds / 60:.3g} min"


def attach_negative_numbers(words: Sequence[str]) -> list[str]:
    """Joins an option and the negative number after it, which argparse takes for an option."""
    joined: list[str] = []
    for word in words:
        if _NUMBER.match(word) and joined and re.fullmatch("--[^=]+", joined[-1]):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _numbers(text: str) -> tuple[float, ...]:
    return tuple(float(part) for part in text.split(","))


_CONVERSIONS: dict[str, Callable[[str], Any]] = {
    "boolean": {"true": True, "false": False}.__getitem__,
    "integer": int,
    "real": float,
    "choice": str,
    "direction": _numbers,
    "position": _numbers,
}
