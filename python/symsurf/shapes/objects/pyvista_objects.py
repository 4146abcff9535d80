"""PyVista's data sets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pyvista
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import vtkStringArray

from ..grids import (
    colours_of,
    drop_normals,
    faces_of,
    is_grid,
    poly_data,
    require_sound_cells,
    turned_inside_out,
)
from .parts import Parts, Remade

_Carried = Callable[[NDArray[Any]], NDArray[Any]]


def parts_of(given: pyvista.DataSet) -> Parts:
    """Of one that is no regular grid."""
    return Parts(given.points, faces_of(given), colours_of(given))


def grid_of(given: pyvista.DataSet) -> pyvista.DataSet | None:
    """The data set, where its points are those of a regular grid."""
    return given if is_grid(given) else None


def remade(given: pyvista.DataSet, made: Remade) -> pyvista.DataSet:
    """A copy whose cells are as they were; a surface of triangles, or points, where the points and
    faces are others. Figures become field data."""
    copy = _other(given, made) if made.is_other else _copy(given, made)
    for name, values in made.arrays.items():
        copy.point_data[name] = values
    for name, values in made.face_arrays.items():
        copy.cell_data[name] = values
    for name, value in made.figures.items():
        if isinstance(value, str):
            copy.GetFieldData().AddArray(_text(name, value))
        else:
            copy.field_data[name] = np.atleast_1d(value)
    return copy


def _copy(given: pyvista.DataSet, made: Remade) -> pyvista.DataSet:
    if made.turned:
        return turned_inside_out(given, made.points)
    copy = given.copy()
    if made.moved:
        copy.points = made.points
        drop_normals(copy)
    if made.carried is not None:
        kept = copy.point_data.active_texture_coordinates_name if made.keeps_texture else None
        _carry(given.point_data, copy.point_data, made.of_points, kept)
    return copy


def _other(given: pyvista.DataSet, made: Remade) -> pyvista.PolyData:
    mesh = poly_data(made.points, made.faces)
    _carry(given.point_data, mesh.point_data, made.of_points)
    if made.given_faces:
        require_sound_cells(given)  # ``faces`` may stand in place of them
        triangles = given.triangulate()
        if triangles.n_cells == made.given_faces:  # neither lines nor vertices beside
            _carry(triangles.cell_data, mesh.cell_data, made.of_faces)
    return mesh


def _carry(
    before: pyvista.DataSetAttributes,
    after: pyvista.DataSetAttributes,
    carried: _Carried,
    kept: str | None = None,
) -> None:
    """Carries the attributes along, but for one; normals, which would be wrong, not."""
    for name, values in before.items():
        if name in (before.active_normals_name, kept):
            continue
        after[name] = carried(np.asarray(values))
        if name == before.active_texture_coordinates_name:
            after.active_texture_coordinates = after[name]


def _text(name: str, value: str) -> vtkStringArray:
    """PyVista itself makes arrays of ASCII alone; groups such as D∞h are not."""
    array = vtkStringArray()
    array.SetName(name)
    array.InsertNextValue(value)
    return array
