"""PyVista's data sets: the faces of meshes, and the points of masks and images."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista
from numpy.typing import NDArray

from ._core import InvalidInput, InvalidParameter

_FLAT_CELLS = {
    int(kind)
    for kind in (pyvista.CellType.TRIANGLE, pyvista.CellType.QUAD, pyvista.CellType.POLYGON)
}


def faces_of(mesh: pyvista.DataSet) -> NDArray[np.int64] | None:
    """The triangles between a data set's points, polygons divided; None where it has no faces.

    Of an unstructured or a curved structured grid those of its cells, where all are flat.
    """
    if isinstance(mesh, pyvista.StructuredGrid):
        mesh = mesh.cast_to_unstructured_grid()
    if isinstance(mesh, pyvista.UnstructuredGrid):
        if mesh.n_cells == 0 or not set(np.unique(mesh.celltypes).tolist()) <= _FLAT_CELLS:
            return None
        mesh = pyvista.PolyData(np.asarray(mesh.points), faces=mesh.cells)
    if not isinstance(mesh, pyvista.PolyData):
        return None
    if mesh.GetNumberOfPolys() + mesh.GetNumberOfStrips() == 0:
        return None
    return np.asarray(mesh.triangulate().regular_faces).astype(np.int64)


def is_grid(data: pyvista.DataSet) -> bool:
    """Whether the points are those of a regular grid, whose symmetry is nobody's question."""
    if isinstance(data, (pyvista.ImageData, pyvista.RectilinearGrid)):
        return True
    return isinstance(data, pyvista.StructuredGrid) and _is_regular(data)


def points_above(
    grid: pyvista.DataSet, threshold: float | None, scalars: str | None
) -> NDArray[np.float64]:
    """The grid's points, or centres of cells, whose scalar is above the threshold; of a mask, which
    holds two values, those with the greater one.

    Raises InvalidInput for a grid without scalars, an image without a threshold, or where none is
    above; InvalidParameter for a threshold that is no number.
    """
    kind = type(grid).__name__
    values, of_cells = _scalars(grid, scalars, kind)
    if threshold is None:
        chosen = _mask(values, kind)
    else:
        if not _is_number(threshold):
            raise InvalidParameter(f"threshold is {threshold!r}; allowed is a number")
        chosen = values > threshold
    if not chosen.any():
        raise InvalidInput(
            f"no scalar of the {kind} is above threshold={threshold}; they end at {values.max()}"
        )
    numbers = np.flatnonzero(chosen)
    if not of_cells:
        return np.ascontiguousarray(np.asarray(grid.points, dtype=float)[numbers])
    return np.ascontiguousarray(np.asarray(grid.cell_centers().points, dtype=float)[numbers])


def _is_number(value: Any) -> bool:
    text = isinstance(value, (str, bytes))
    return not text and np.isscalar(value) and not np.isnan(value)


def _scalars(grid: pyvista.DataSet, name: str | None, kind: str) -> tuple[NDArray[Any], bool]:
    if name is None:
        name = grid.active_scalars_name
        if name is None:
            names = [*grid.point_data, *grid.cell_data]
            name = names[0] if len(names) == 1 else None
    if name is None:
        there_are = ", ".join(map(repr, [*grid.point_data, *grid.cell_data])) or "none"
        raise InvalidInput(
            f"the {kind} is a regular grid, and no scalars are active to choose points of it by; "
            f"give scalars=NAME (there are {there_are}) and threshold=NUMBER, or an array of points"
        )
    for data, of_cells in ((grid.point_data, False), (grid.cell_data, True)):
        if name in data:
            values = np.asarray(data[name])
            if values.ndim != 1 or values.dtype.kind not in "biuf":
                raise InvalidInput(
                    f"scalars={name!r} have shape {values.shape} and type {values.dtype}; allowed is "
                    "one real number a point or cell"
                )
            return values, of_cells
    raise InvalidInput(
        f"scalars={name!r} are not there; there are "
        + (", ".join(map(repr, [*grid.point_data, *grid.cell_data])) or "none")
    )


def _mask(values: NDArray[Any], kind: str) -> NDArray[np.bool_]:
    if values.dtype.kind == "b":
        return values
    if values.dtype.kind in "iu" and values.size:
        low, high = values.min(), values.max()
        if low != high and ((values == low) | (values == high)).all():
            return values == high
    raise InvalidInput(
        f"the {kind} is a regular grid, whose own symmetry is not asked for, and its scalars are no "
        f"mask of two values; give threshold=NUMBER to choose the points above it (they go from "
        f"{values.min()} to {values.max()})"
        if values.size
        else f"the {kind} has no points"
    )


def _is_regular(grid: Any) -> bool:
    """Whether a structured grid's points are sums of steps along three straight lines."""
    x = np.asarray(grid.points, dtype=float).reshape(*grid.dimensions[::-1], 3)
    origin = x[0, 0, 0]
    lines = x[:, :1, :1] - origin, x[:1, :, :1] - origin, x[:1, :1, :] - origin
    rounding = 1e-6 * (float(np.linalg.norm(np.ptp(x.reshape(-1, 3), axis=0))) + 1e-300)
    if np.abs(x - (origin + lines[0] + lines[1] + lines[2])).max() > rounding:
        return False
    return all(_is_straight(line.reshape(-1, 3), rounding) for line in lines)


def _is_straight(line: NDArray[np.float64], rounding: float) -> bool:
    direction = line[np.abs(line).max(axis=1).argmax()]
    length = np.linalg.norm(direction)
    if length == 0:
        return True
    direction = direction / length
    return bool(np.abs(line - np.outer(line @ direction, direction)).max() <= rounding)
