"""The mirror that an argument stands for."""

from __future__ import annotations

from .._core import InvalidInput, InvalidParameter, Mirror
from .result import Result


def mirror_of(given: object, argument: str = "mirror") -> Mirror:
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


def found_mirror(result: Result, require_found: bool = False) -> tuple[Mirror, str]:
    """The mirror of a detection, and a warning for the caller where its verdict is "none", else "".

    Raises InvalidInput where there is no mirror, and, with ``require_found``, where the verdict is
    "none".
    """
    found = result.verdict == "found"
    if not found and (require_found or result.mirror is None):
        raise InvalidInput(f"the shape has no mirror: {result.reason}")
    mirror = mirror_of(result)
    if found:
        return mirror, ""
    return mirror, (
        f'the verdict on the mirror is "none": {result.reason}; it is used all the same, with '
        "require_found this is an error"
    )
