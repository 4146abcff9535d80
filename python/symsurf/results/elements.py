"""What analyses find: axes, and what maps a shape or a part of it onto another."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Axis:
    """An axis of rotation: found, or made by hand."""

    point: NDArray[np.float64]
    """(3,) on the axis, in input units: the centre of the group."""
    direction: NDArray[np.float64]
    """(3,), of length 1 where it is found."""
    order: int = 0
    """A turn by 360 degrees / order maps the shape onto itself; 0: any turn."""
    ends: NDArray[np.float64] = field(default_factory=lambda: np.full((2, 3), np.nan))
    """(2, 3) of the piece to draw: along the shape and a little beyond; NaN where made by hand."""

    @property
    def continuous(self) -> bool:
        return self.order == 0

    def __repr__(self) -> str:
        direction = ", ".join(f"{number:.4g}" for number in self.direction)
        return f"Axis(order={self.order or 'continuous'}, direction=({direction}))"


SymmetryAxis = Axis
"""The name that it has in C++."""


@dataclass(frozen=True, eq=False)
class Transformation:
    """A motion, reflection or similarity that maps a shape, or a part of it, onto another part."""

    kind: str
    """"identity", "rotation", "translation", "screw", "reflection", "glide reflection",
    "inversion", "rotary reflection" or "similarity"."""
    matrix: NDArray[np.float64]
    """(4, 4): ``matrix @ (x, y, z, 1)``, input units."""
    score: float
    """How well what is mapped fits, 0 to 1."""
    from_points: NDArray[np.int64]
    """(k,) indices of the points that are mapped, ascending; none: all."""
    onto_points: NDArray[np.int64]
    """(l,) indices of the points that they fall on, ascending; none: all."""
    place: NDArray[np.float64]
    """(3,) where to draw it: the image of the centroid of the points that are mapped."""

    def __repr__(self) -> str:
        points = len(self.from_points) or "all"
        return f"Transformation({self.kind}, {points} points, score {self.score:.3f})"


class TolerancedGroup(NamedTuple("_TolerancedGroup", [("tolerance", float), ("group", str)])):
    """A point group that holds within a tolerance: ``tolerance, group = ...``.

    ``tolerance`` is the maximum deviation of the images of the surface under all elements, in input
    units; ``group`` the name, as of ``Symmetries``.
    """

    quantile: float
    """95 % quantile of the deviation over the surface, input units."""
    elements: NDArray[np.float64]
    """(n, 4, 4), the identity first, as of ``Symmetries``."""
    axes: list[Axis]
    """The continuous axes."""


def toleranced_group(fields: tuple[Any, ...]) -> TolerancedGroup:
    """From what the core gives."""
    tolerance, group, quantile, elements, axes = fields
    made = TolerancedGroup(tolerance, group)
    made.quantile = quantile
    made.elements = np.array(elements)
    made.axes = [Axis(*axis) for axis in axes]
    return made
