"""The mirror that an argument stands for."""

from __future__ import annotations

from .._core import InvalidInput, InvalidParameter, Mirror, Plane
from .result import Result


def mirror_of(given: object, argument: str = "mirror") -> Mirror:
    """The mirror itself, that of a result, or the plane of an equation.

    Raises InvalidInput for a result without a mirror, InvalidParameter, which names the argument, for
    what is none of these.
    """
    if isinstance(given, Mirror):
        return given
    if isinstance(given, str):
        return plane_of(given, argument)
    if not isinstance(given, Result):
        raise InvalidParameter(
            f"{argument} is of type {type(given).__name__}; allowed is a Result, a Mirror or a plane "
            "such as 'x=0'"
        )
    if given.mirror is None:
        raise InvalidInput(f"the result of {given.method} has no mirror")
    return given.mirror


def plane_of(equation: str, argument: str = "mirror") -> Plane:
    """The plane across an axis of coordinates, such as "x=0" or "y=-1.5", with its normal along the
    axis. Raises InvalidParameter, which names the argument."""
    axis, _, position = equation.replace(" ", "").partition("=")
    try:
        normal = [float(name == axis) for name in "xyz"]
        return Plane(normal, 0.0 - float(position))  # no -0.0
    except ValueError:
        raise InvalidParameter(
            f"{argument} is {equation!r}; allowed is x, y or z and a finite number, such as 'x=0' or "
            "'y=-1.5'"
        ) from None


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
