"""All symmetries of a shape: its point group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .detection import Progress
from .inputs import as_input, refuses


@dataclass(frozen=True, eq=False)
class Axis:
    """A line about which a shape may be turned."""

    point: NDArray[np.float64]
    """(3,) on the axis, in input units: the centre of the group."""
    direction: NDArray[np.float64]
    """(3,), of length 1."""
    order: int
    """A turn by 360 degrees / order maps the shape onto itself; 0: any turn."""

    @property
    def continuous(self) -> bool:
        return self.order == 0

    def __repr__(self) -> str:
        direction = ", ".join(f"{number:.4g}" for number in self.direction)
        return f"Axis(order={self.order or 'continuous'}, direction=({direction}))"


@dataclass(frozen=True, eq=False)
class Symmetries:
    """What maps a shape onto itself."""

    group: str
    """In Schoenflies' notation: "C1", "Cs", "D6h", "Oh", "C∞v", "D∞h", "K", ..."""
    centre: NDArray[np.float64]
    """(3,) in input units: all elements keep it in its place."""
    planes: list[_core.Plane]
    """All mirror planes; of a continuous group one that holds the axis and the one across it, where
    there is one; of K none."""
    axes: list[Axis]
    """All rotation axes, the highest order first, a continuous one before; of D∞h one of those of
    order 2, of K three at right angles."""
    inversion: bool
    """Whether x -> 2 centre - x maps the shape onto itself."""
    elements: NDArray[np.float64]
    """(n, 4, 4): every element on homogeneous columns, the identity first. Of a continuous group
    those that, with the turns about the continuous axes, make up all."""
    score: float
    """How well the images under all elements lie on the shape where it has points, 0 to 1."""
    missing: float
    """The share of the images that fall where the shape has no points: what is cut away."""
    seconds: float

    @property
    def order(self) -> int | None:
        """How many elements the group has; None: no end of them."""
        return None if any(axis.continuous for axis in self.axes) else len(self.elements)

    def __repr__(self) -> str:
        return (
            f"Symmetries({self.group}, {len(self.planes)} planes, {len(self.axes)} axes, "
            f"score {self.score:.3f})"
        )

    def to_json(self) -> dict[str, Any]:
        """Every field by its name, in what ``json.dumps`` takes; an axis has the order
        "continuous" in place of 0."""
        return {
            "group": self.group,
            "centre": self.centre.tolist(),
            "planes": [
                {"normal": plane.normal.tolist(), "offset": plane.offset} for plane in self.planes
            ],
            "axes": [
                {
                    "point": axis.point.tolist(),
                    "direction": axis.direction.tolist(),
                    "order": axis.order or "continuous",
                }
                for axis in self.axes
            ],
            "inversion": self.inversion,
            "elements": self.elements.tolist(),
            "score": self.score,
            "missing": self.missing,
            "seconds": self.seconds,
        }

    def to_bop(self) -> dict[str, Any]:
        """The rotations as an entry of the BOP toolkit's ``models_info.json`` has them.

        ``symmetries_discrete``: 4 x 4 matrices, row by row in lists of 16, without the identity;
        ``symmetries_continuous``: dictionaries with axis and offset, a point on the axis. Either is
        left out where there are none. Lengths are in the unit of the input; the toolkit's is the
        millimetre. Reflections, which no object can be moved by, are not among them.
        """
        turns = [each for each in self.elements[1:] if np.linalg.det(each[:3, :3]) > 0]
        continuous = [
            {"axis": axis.direction.tolist(), "offset": axis.point.tolist()}
            for axis in self.axes
            if axis.continuous
        ]
        entry: dict[str, Any] = {}
        if turns:
            entry["symmetries_discrete"] = [turn.ravel().tolist() for turn in turns]
        if continuous:
            entry["symmetries_continuous"] = continuous
        return entry


def symmetries(
    shape: object,
    *,
    faces: ArrayLike | None = None,
    minimum_score: float = 0.7,
    nonfinite: str = "skip",
    threads: int = 0,
    progress: Progress | None = None,
) -> Symmetries:
    """Finds all symmetries of a shape: mirror planes, rotation axes, inversion, and their group.

    Args:
        shape: points, a mesh or a file, as ``detect`` takes them.
        faces: (m, 3) indices of points, where ``shape`` does not bring them.
        minimum_score: what a group must score, [0, 1].
        nonfinite, threads, progress: as for ``detect``.

    Raises:
        InvalidInput, Cancelled: as ``detect`` does.
        InvalidParameter: minimum_score is out of its range.

    A shape without any symmetry is no error: its group is "C1".
    """
    given = as_input(shape, faces)
    fields = _core.find_symmetries(
        given.points, given.faces, refuses(nonfinite), minimum_score, threads, progress
    )
    return Symmetries(
        **fields
        | {
            "axes": [Axis(*axis) for axis in fields["axes"]],
            "elements": np.array(fields["elements"]),
        }
    )
