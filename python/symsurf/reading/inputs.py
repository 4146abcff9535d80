"""What ``detect`` takes: files, shapes, meshes, grids and arrays, as points and faces."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput, InvalidParameter
from ..base.input_warning import warn_of
from ..base.options import Reading, part
from ..shapes import Shape, objects
from . import read


@dataclass(frozen=True, eq=False)
class Input:
    """Points and faces as they were given."""

    points: Any
    """What the core reads as (n, 3) numbers."""
    faces: NDArray[np.int64] | None
    """(m, 3) indices of points; None for a bare cloud."""
    colours: Any = None
    """(n, k) of the points, where the input brings some."""
    shape: Shape = field(default_factory=lambda: Shape(np.empty((0, 3))))
    """What is known beside them, in the fields of a shape that was given or read."""

    @property
    def space(self) -> str | None:
        return self.shape.space

    def as_shape(self, points: NDArray[np.float64], **fields: Any) -> Shape:
        """The shape with the points as the core has read them."""
        return replace(self.shape, points=points, faces=self.faces, **fields)


def as_input(
    given: Any,
    faces: ArrayLike | None = None,
    reading: Reading | None = None,
) -> Input:
    """The points of a path, a data set, a mesh or an array, and their faces, where there are some.

    Args:
        given: see ``symsurf.detect``.
        faces: in place of those of the mesh.
        reading: of files and grids.
    """
    reading = reading or Reading()
    if isinstance(given, (str, os.PathLike)):
        given = read(given, **part(Reading, reading))
        reading = Reading()
    grid = objects.grid_of(given)
    if grid is not None:
        from ..shapes import grids

        if faces is not None:
            raise InvalidInput("faces are given with a grid, which has none; leave them out")
        return Input(grids.chosen_points(grid, reading), None)
    for name, value in reading.of_image().items():
        raise InvalidParameter(
            f"{name} is {value!r}; allowed is None, as the input is no grid of PyVista"
        )
    if faces is not None:
        return Input(_points(given), triangles(faces))
    parts = objects.parts_of(given)
    if parts is not None:
        return Input(parts.points, _faces(parts.faces), colours=parts.colours)
    known = {"shape": given} if isinstance(given, Shape) else {}
    if not known and (hasattr(given, "__array__") or isinstance(given, (list, tuple))):
        return Input(given, None)
    points, own = _points(given), _faces(_first_of(given, "faces", "triangles"))
    return Input(points, own, _colours(given), **known)


def triangles(faces: ArrayLike) -> NDArray[np.int64]:
    """Raises InvalidInput unless they are (m, 3) whole numbers."""
    array = np.asarray(faces)
    if array.size == 0:
        return np.empty((0, 3), np.int64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"faces have shape {array.shape}; allowed is (m, 3)")
    if array.dtype.kind not in "iu":
        raise InvalidInput(f"faces are of type {array.dtype}; allowed are whole numbers")
    return np.ascontiguousarray(array, np.int64)


def refuses(nonfinite: str) -> bool:
    """Whether the option ``nonfinite`` says to refuse points that are not finite."""
    if nonfinite not in ("skip", "refuse"):
        raise InvalidParameter(f"nonfinite is {nonfinite!r}; allowed is 'skip' or 'refuse'")
    return nonfinite == "refuse"


def require_finite(points: Any) -> None:
    """Raises InvalidInput, of rows that the option ``nonfinite`` refuses."""
    count = np.count_nonzero(~np.isfinite(np.asarray(points, dtype=float)).all(axis=-1))
    if count:
        raise InvalidInput(f"{count} points are not finite")


def warn(statistics: dict[str, Any]) -> None:
    """An InputWarning with the number of points that were left out, where there are some, and one
    with what the method warns of."""
    messages = []
    if statistics.get("nonfinite_points", 0):
        messages.append(nonfinite_message(statistics["nonfinite_points"]))
    if "warning" in statistics:
        messages.append(statistics["warning"])
    warn_of(messages)


def nonfinite_message(count: int) -> str:
    were = (
        "1 point is not finite: it is" if count == 1 else f"{count} points are not finite: they are"
    )
    return f"{were} left out; with nonfinite 'refuse' this is an error"


def _faces(given: Any) -> NDArray[np.int64] | None:
    return None if given is None or not len(given) else triangles(given)


def _points(given: Any) -> Any:
    points = objects.points_of(given)
    if points is given and np.asarray(given, dtype=object).ndim == 0:
        raise InvalidInput(
            f"points are of type {type(given).__name__}; allowed are an array or a nested list (n, 3), "
            "the name of a file, a Shape, or a mesh, a table or a data set with points or vertices"
        )
    return points


def _colours(given: Any) -> Any:
    found = _first_of(given, "colours", "vertex_colors", "colors")
    return None if found is None or not len(found) else found


def _first_of(given: Any, *attributes: str) -> Any:
    for attribute in attributes:
        if hasattr(given, attribute):
            return getattr(given, attribute)
    return None
