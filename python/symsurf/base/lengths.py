"""Lengths in the unit of the input, as the fractions of the diagonal that the core takes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from numbers import Real
from typing import Any

import numpy as np

from .._core import InvalidParameter, Parameter


def as_fractions(
    values: Mapping[str, Any], parameters: Iterable[Parameter], diagonal: Callable[[], float]
) -> dict[str, Any]:
    """The values, those of the unit "diagonal" divided by it.

    Args:
        values: of a method or an operation, by name; lengths are in input units.
        parameters: their descriptions. What is no number is left for the core to refuse.
        diagonal: asked for its length only where there is something to divide.

    Raises:
        InvalidParameter: a length that is out of its range, naming both in input units.
    """
    lengths = {each.name: each for each in parameters if each.unit == "diagonal"}
    given = {
        name: float(value)
        for name, value in values.items()
        if name in lengths and isinstance(value, Real) and not isinstance(value, bool)
    }
    if not given:
        return dict(values)
    unit = diagonal()
    for name, length in given.items():
        low, high = (unit * end for end in (lengths[name].minimum, lengths[name].maximum))
        if not low <= length <= high:
            raise InvalidParameter(
                f"{name} is {length:g} input units; allowed is real [{low:g}, {high:g}] input units, "
                f"which is {lengths[name].allowed}"
            )
    return dict(values) | {name: length / unit for name, length in given.items()}


def diagonal_of(points: Any) -> float:
    """Of the axis-aligned bounding box of the finite points; (n, 3)."""
    array = np.asarray(points, dtype=float)
    return float(np.linalg.norm(np.ptp(array[np.isfinite(array).all(axis=1)], axis=0)))
