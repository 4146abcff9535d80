"""PyVista's data sets: the faces of meshes, and the points of masks and images."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkGenericCell
from vtkmodules.vtkFiltersCore import vtkReverseSense
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

from .._core import InvalidInput
from ..base.options import Reading
from .thresholds import chosen_by

_FLAT_CELLS = {
    int(kind)
    for kind in (pyvista.CellType.TRIANGLE, pyvista.CellType.QUAD, pyvista.CellType.POLYGON)
}
_THIN_CELLS = {
    int(kind)
    for kind in (
        pyvista.CellType.VERTEX,
        pyvista.CellType.POLY_VERTEX,
        pyvista.CellType.LINE,
        pyvista.CellType.POLY_LINE,
    )
}


def faces_of(mesh: pyvista.DataSet) -> NDArray[np.int64] | None:
    """The triangles between a data set's points, polygons divided; None where it has no faces.

    Of an unstructured or a curved structured grid those of its cells, where all are flat, or the outer
    surface of those that are solid. Raises InvalidInput for broken cells, whatever their kind.
    """
    require_sound_cells(mesh)
    if isinstance(mesh, pyvista.StructuredGrid):
        mesh = mesh.cast_to_unstructured_grid()
    if isinstance(mesh, pyvista.UnstructuredGrid):
        kinds = np.unique(mesh.celltypes).tolist()
        if solid := [kind for kind in kinds if _dimension(kind) == 3]:
            return _outer_faces(mesh, np.flatnonzero(np.isin(mesh.celltypes, solid)))
        if not kinds or not set(kinds) <= _FLAT_CELLS:
            return None
        mesh = pyvista.PolyData(np.asarray(mesh.points), faces=mesh.cells)
    if not isinstance(mesh, pyvista.PolyData):
        return None
    if mesh.GetNumberOfPolys() + mesh.GetNumberOfStrips() == 0:
        return None
    return np.asarray(mesh.triangulate().regular_faces).astype(np.int64)


def _dimension(kind: int) -> int:
    return vtkGenericCell.InstantiateCell(kind).GetCellDimension()


def _outer_faces(grid: pyvista.UnstructuredGrid, cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Between the grid's own points: the faces that one of the cells alone has, as triangles."""
    numbered = pyvista.UnstructuredGrid(grid.cells, grid.celltypes, grid.points)
    numbered.point_data["number"] = np.arange(grid.n_points)
    surface = vtkDataSetSurfaceFilter()
    surface.SetNonlinearSubdivisionLevel(0)
    surface.SetInputData(numbered.extract_cells(cells))
    surface.Update()
    made = pyvista.wrap(surface.GetOutput()).triangulate()
    number = np.asarray(made.point_data["number"])
    return number[np.asarray(made.regular_faces)].astype(np.int64)


def require_sound_cells(data: pyvista.DataSet) -> None:
    """Raises InvalidInput where a cell names a point that is not there: VTK's filters would read what
    lies beside the points."""
    if isinstance(data, pyvista.PolyData):
        arrays = [data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()]
    elif isinstance(data, pyvista.UnstructuredGrid):
        arrays = [data.GetCells()]
    else:
        return
    for cells in arrays:
        corners = vtk_to_numpy(cells.GetConnectivityArray())
        ends = vtk_to_numpy(cells.GetOffsetsArray())
        outside = corners[(corners < 0) | (corners >= data.n_points)]
        if len(outside):
            raise InvalidInput(f"a cell names point {outside[0]}; there are {data.n_points} points")
        if len(ends) and (ends[0] != 0 or ends[-1] != len(corners) or (np.diff(ends) < 0).any()):
            raise InvalidInput("the cells do not end where the next begin")


def shape_of(
    mesh: pyvista.DataSet,
) -> tuple[NDArray[np.float64], NDArray[np.int64] | None, NDArray[np.float64] | None]:
    """Points, triangles and point normals of a data set; None for those that it has not."""
    if not isinstance(mesh, pyvista.DataSet):
        raise InvalidInput(
            f"mesh is of type {type(mesh).__name__}; allowed is a data set of PyVista"
        )
    normals = mesh.point_data.active_normals
    return (
        np.array(mesh.points, dtype=np.float64),
        faces_of(mesh),
        None if normals is None else np.array(normals, dtype=np.float64),
    )


def colours_of(mesh: pyvista.DataSet) -> NDArray[np.float64] | None:
    """The active point scalars, where these are whole numbers of 3 or 4 channels."""
    values = mesh.point_data.active_scalars
    if values is None or values.ndim != 2 or values.shape[1] not in (3, 4):
        return None
    return np.array(values, dtype=np.float64) if values.dtype.kind == "u" else None


def poly_data(
    points: NDArray[np.float64],
    faces: NDArray[np.int64] | None,
    normals: NDArray[np.float64] | None = None,
) -> pyvista.PolyData:
    """A mesh of triangles, or of vertices where there are none."""
    if faces is None or not len(faces):
        mesh = pyvista.PolyData(np.array(points))
    else:
        mesh = pyvista.PolyData.from_regular_faces(np.array(points), faces)
    if normals is not None:
        mesh.point_data.active_normals = np.array(normals)
    return mesh


def turned_inside_out(mesh: pyvista.DataSet, points: NDArray[np.float64]) -> pyvista.DataSet:
    """A copy at these points, without normals, the corners of each face the other way round.

    Raises InvalidInput for a data set with other cells than points, lines and flat faces, and for
    broken cells.
    """
    require_sound_cells(mesh)
    if isinstance(mesh, pyvista.PolyData):
        reverse = vtkReverseSense()
        # A strip of an even number of triangles is wound alike from both ends.
        reverse.SetInputData(mesh.triangulate() if mesh.n_strips else mesh)
        reverse.ReverseCellsOn()
        reverse.ReverseNormalsOff()
        reverse.Update()
        made = pyvista.wrap(reverse.GetOutput())
    elif isinstance(mesh, pyvista.UnstructuredGrid) and _is_flat(mesh):
        made = pyvista.UnstructuredGrid(
            _backwards(mesh.cells, vtk_to_numpy(mesh.GetCells().GetOffsetsArray())),
            mesh.celltypes,
            np.asarray(mesh.points),
        )
        made.copy_attributes(mesh)
    else:
        raise InvalidInput(
            f"the cells of this {type(mesh).__name__} cannot be turned round; give a surface of it, "
            "such as extract_surface()"
        )
    made.SetPoints(pyvista.vtk_points(points))  # which it may share with the mesh
    drop_normals(made)
    return made


def drop_normals(mesh: pyvista.DataSet) -> None:
    """Takes the active normals of points and cells away: those of points that have moved are wrong."""
    for data in (mesh.point_data, mesh.cell_data):
        if data.active_normals_name is not None:
            del data[data.active_normals_name]


def _is_flat(grid: pyvista.UnstructuredGrid) -> bool:
    return set(np.unique(grid.celltypes).tolist()) <= _FLAT_CELLS | _THIN_CELLS


def _backwards(cells: NDArray[np.int64], offset: NDArray[np.int64]) -> NDArray[np.int64]:
    """VTK's list of cells, each its number of corners and these, with the corners backwards."""
    sizes = np.diff(offset)
    first = offset[:-1] + np.arange(len(sizes)) + 1  # behind the number of corners
    rows = np.repeat(2 * first + sizes - 1, sizes)
    corners = np.delete(np.arange(len(cells)), first - 1)
    turned = np.array(cells)
    turned[corners] = cells[rows - corners]
    return turned


def is_grid(data: pyvista.DataSet) -> bool:
    """Whether the points are those of a regular grid, whose symmetry is nobody's question."""
    if isinstance(data, (pyvista.ImageData, pyvista.RectilinearGrid)):
        return True
    return isinstance(data, pyvista.StructuredGrid) and _is_regular(data)


def chosen_points(grid: pyvista.DataSet, reading: Reading) -> NDArray[np.float64]:
    """The grid's points, or centres of cells, that ``chosen_by`` says.

    Raises InvalidInput for a grid without scalars, and what ``chosen_by`` raises.
    """
    kind = type(grid).__name__
    values, of_cells = _scalars(grid, reading.scalars, kind)
    chosen = chosen_by(values, reading, kind)
    numbers = np.flatnonzero(chosen)
    if isinstance(grid, pyvista.StructuredGrid):
        all_ = grid.cell_centers().points if of_cells else grid.points
        return np.ascontiguousarray(np.asarray(all_, dtype=float)[numbers])
    return _points_at(grid, numbers, of_cells)


def _points_at(grid: Any, numbers: NDArray[np.int64], of_cells: bool) -> NDArray[np.float64]:
    """Some points, or centres of cells, of an image or a rectilinear grid: all of them may take far
    more memory than the scalars."""
    count = np.array(grid.dimensions)
    halves = 0.5 * (of_cells & (count > 1))  # an axis of one point has one layer of cells
    cells = np.maximum(count - 1, 1) if of_cells else count
    index = np.column_stack(np.unravel_index(numbers, cells, order="F"))
    if isinstance(grid, pyvista.ImageData):
        steps = (index + np.array(grid.extent[::2]) + halves) * grid.spacing
        return np.ascontiguousarray(steps @ np.asarray(grid.direction_matrix).T + grid.origin)
    middles = [
        0.5 * (x[:-1] + x[1:]) if half else x
        for x, half in zip(map(_doubles, (grid.x, grid.y, grid.z)), halves)
    ]
    return np.column_stack([x[i] for x, i in zip(middles, index.T)])


def _doubles(values: Any) -> NDArray[np.float64]:
    return np.asarray(values, dtype=float)


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
                    "one real number per point or cell"
                )
            return values, of_cells
    raise InvalidInput(
        f"scalars={name!r} are not there; there are "
        + (", ".join(map(repr, [*grid.point_data, *grid.cell_data])) or "none")
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
