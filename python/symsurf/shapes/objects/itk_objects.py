"""ITK's meshes and point sets."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import itk
import numpy as np
from numpy.typing import NDArray

from .parts import Parts, Remade

# The flat cells of itk::CommonEnums::CellGeometry.
_TRIANGLE, _QUADRILATERAL, _POLYGON = 2, 3, 4
_FLAT = (_TRIANGLE, _QUADRILATERAL, _POLYGON)


def parts_of(given: Any) -> Parts:
    """Faces are the flat cells, polygons divided into fans of triangles; a body's cells are none."""
    faces = _triangles(_array(given.GetCellsArray())) if hasattr(given, "GetCellsArray") else None
    return Parts(_array(given.GetPoints()), faces)


def remade(given: Any, made: Remade) -> Any:
    """With its point data, where these are one number per point: ITK has no room for more."""
    copy = type(given).New()
    points = made.points.astype(_array(given.GetPoints()).dtype)
    copy.SetPoints(itk.vector_container_from_array(points.ravel()))
    if hasattr(copy, "SetCellsArray") and made.faces is not None:
        head = np.tile((_TRIANGLE, 3), (len(made.faces), 1))
        cells = np.hstack([head, made.faces]).astype(np.uint64)
        copy.SetCellsArray(itk.vector_container_from_array(cells.ravel()))
    data = _array(given.GetPointData())
    if data.ndim == 1 and len(data) == given.GetNumberOfPoints():
        kept = made.of_points(data).astype(data.dtype)
        copy.SetPointData(itk.vector_container_from_array(kept))
    return copy


def _array(container: Any) -> NDArray[Any]:
    """A copy; empty where there is nothing."""
    if container is None or container.Size() == 0:
        return np.empty(0)
    return itk.array_from_vector_container(container)


def _triangles(cells: NDArray[Any]) -> NDArray[np.int64] | None:
    """The cells stand behind each other: the kind, the number of corners, the corners."""
    cells = cells.astype(np.int64)
    if len(cells) % 5 == 0 and (cells.reshape(-1, 5)[:, :2] == (_TRIANGLE, 3)).all():
        return cells.reshape(-1, 5)[:, 2:]
    triangles = []
    first = 0
    while first < len(cells):
        kind, count = cells[first : first + 2]
        corners = cells[first + 2 : first + 2 + count]
        if kind in _FLAT:
            triangles += [(corners[0], *pair) for pair in pairwise(corners[1:])]
        first += 2 + count
    return np.array(triangles) if triangles else None
