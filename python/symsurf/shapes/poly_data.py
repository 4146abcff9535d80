"""Points and faces of VTK's poly data, without PyVista."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkTriangleFilter

from .._core import InvalidInput


def rows_of(array: vtkDataArray | None) -> NDArray[Any]:
    return np.empty((0, 3)) if array is None else vtk_to_numpy(array)


def points_of(data: vtkPolyData) -> NDArray[Any]:
    return rows_of(data.GetPoints() and data.GetPoints().GetData())


class Faces(NamedTuple):
    """The polygons and strips of a data set, divided into triangles."""

    corners: NDArray[np.int64] | None
    """(m, 3) indices of points; None where there are no polygons."""
    cells: NDArray[np.int64]
    """(m,) of each triangle, the cell that it is a part of."""


def faces_of(data: vtkPolyData) -> Faces:
    """Of data whose cells name points that are there."""
    if data.GetNumberOfPolys() + data.GetNumberOfStrips() == 0:
        return Faces(None, np.empty(0, np.int64))
    polygons = vtkPolyData()
    polygons.SetPoints(data.GetPoints())
    polygons.SetPolys(data.GetPolys())
    polygons.SetStrips(data.GetStrips())
    first = data.GetNumberOfVerts() + data.GetNumberOfLines()
    numbers = np.arange(first, first + polygons.GetNumberOfCells(), dtype=np.int64)
    polygons.GetCellData().AddArray(numpyTovtkDataArray(numbers, "cell"))
    divided = vtkTriangleFilter()
    divided.SetInputData(polygons)
    divided.Update()
    triangles = divided.GetOutput()
    corners = vtk_to_numpy(triangles.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return Faces(corners, vtk_to_numpy(triangles.GetCellData().GetArray(0)))


def require_points(named: NDArray[np.int64], count: int) -> None:
    """VTK's own filters read what a cell names without asking whether it is there."""
    beyond = named[(named < 0) | (named >= count)]
    if len(beyond):
        raise InvalidInput(f"a cell names point {beyond[0]}; allowed is 0 to {count - 1}")


def require_sound_cells(data: vtkPolyData) -> None:
    """Raises InvalidInput where a cell names a point that is not there."""
    for cells in (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()):
        require_points(vtk_to_numpy(cells.GetConnectivityArray()), data.GetNumberOfPoints())


def kinds_of(data: vtkDataSetAttributes) -> dict[str, str]:
    """The kinds of the arrays that are the active vectors, normals and tensors, by their names."""
    active = {
        "vector": data.GetVectors(),
        "normal": data.GetNormals(),
        "tensor": data.GetTensors(),
        "scalar": data.GetTCoords(),
    }
    return {array.GetName(): kind for kind, array in active.items() if array and array.GetName()}


def vtk_points(rows: NDArray[np.float64]) -> vtkPoints:
    points = vtkPoints()
    points.SetData(numpyTovtkDataArray(rows))
    return points
