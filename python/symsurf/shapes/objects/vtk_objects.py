"""VTK's data sets without PyVista's methods: poly data as they are, others by PyVista."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkPolyData

from ...base.optional import require
from ..poly_data import faces_of, kinds_of, points_of, require_sound_cells, vtk_points
from .parts import Parts, Remade


def parts_of(given: Any) -> Parts:
    if isinstance(given, vtkPolyData):
        require_sound_cells(given)
        return Parts(points_of(given), faces_of(given).corners)
    return _by_pyvista("parts_of", given)


def grid_of(given: Any) -> Any:
    """The data set as one of PyVista, where its points are those of a regular grid."""
    return None if isinstance(given, vtkPolyData) else _by_pyvista("grid_of", given)


def remade(given: Any, made: Remade) -> Any:
    """Poly data with their own cells, where points stay the data's own; else one of PyVista, which is
    one of VTK as well."""
    is_own = made.keeps and not (made.is_other or made.turned)
    if not isinstance(given, vtkPolyData) or not is_own:
        return _by_pyvista("remade", given, made)
    copy = given.NewInstance()
    copy.ShallowCopy(given)
    if made.moved:
        copy.SetPoints(vtk_points(made.points))
        copy.GetPointData().SetNormals(None)
        copy.GetCellData().SetNormals(None)
    if made.turns:
        _turn(given.GetPointData(), copy.GetPointData(), made)
    for name, values in made.arrays.items():
        column = values.astype(np.uint8) if values.dtype.kind == "b" else values
        copy.GetPointData().AddArray(numpyTovtkDataArray(np.ascontiguousarray(column), name))
    return copy


def _turn(before: vtkDataSetAttributes, after: vtkDataSetAttributes, made: Remade) -> None:
    """Replaces the arrays of directions."""
    known = kinds_of(before)
    for i in range(before.GetNumberOfArrays()):
        array = before.GetArray(i)
        if array is None or array.GetName() is None or array is before.GetNormals():
            continue
        values = vtk_to_numpy(array)
        turned = made.of_points(values, array.GetName(), known.get(array.GetName()))
        if turned is not values:
            after.AddArray(numpyTovtkDataArray(np.ascontiguousarray(turned), array.GetName()))


def _by_pyvista(function: str, given: Any, *arguments: Any) -> Any:
    pyvista = require("VTK's data sets other than poly data", "pyvista")
    from . import pyvista_objects

    return getattr(pyvista_objects, function)(pyvista.wrap(given), *arguments)
