"""The mirror that an argument stands for."""

from __future__ import annotations

from ._core import InvalidInput, InvalidParameter, Mirror
from .result import Result


def mirror_of(given: Result | Mirror, argument: str = "mirror") -> Mirror:
    """The mirror itself, or that of a result.

    Raises InvalidInput for a result without a mirror, InvalidParameter, which names the argument, for
    what is neither.
    """
    if isinstance(given, Mirror):
        return given
    if not isinstance(given, Result):
        raise InvalidParameter(
            f"{argument} is of type {type(given).__name__}; allowed is a Result or a Mirror"
        )
    if given.mirror is None:
        raise InvalidInput(f"the result of {given.method} has no mirror")
    return given.mirror


def found_mirror(result: Result, advice: str = "") -> Mirror:
    """The mirror of a detection whose verdict is "found".

    Raises InvalidInput: with the reason and the advice for another verdict; for a method that finds
    surface points only.
    """
    if result.verdict != "found":
        raise InvalidInput(f"the shape has no mirror: {result.reason}{advice and f'; {advice}'}")
    return mirror_of(result)
