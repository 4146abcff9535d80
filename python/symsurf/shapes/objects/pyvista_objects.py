"""PyVista's data sets."""

from __future__ import annotations

import numpy as np
import pyvista
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
from ..poly_data import kinds_of
from .parts import Parts, Remade


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
    copy = turned_inside_out(given, made.points) if made.turned else given.copy()
    if made.moved and not made.turned:
        copy.points = made.points
        drop_normals(copy)
    if not made.keeps or made.turns:
        kept = copy.point_data.active_texture_coordinates_name if made.keeps_texture else None
        _carry_points(given.point_data, copy.point_data, made, kept)
    return copy


def _other(given: pyvista.DataSet, made: Remade) -> pyvista.PolyData:
    mesh = poly_data(made.points, made.faces)
    _carry_points(given.point_data, mesh.point_data, made)
    if made.given_faces:
        require_sound_cells(given)  # ``faces`` may stand in place of them
        triangles = given.triangulate()
        if triangles.n_cells == made.given_faces:  # neither lines nor vertices beside
            for name, values in triangles.cell_data.items():
                if name != triangles.cell_data.active_normals_name:
                    mesh.cell_data[name] = made.of_faces(values)
    return mesh


def _carry_points(
    before: pyvista.DataSetAttributes,
    after: pyvista.DataSetAttributes,
    made: Remade,
    kept: str | None = None,
) -> None:
    """Carries the attributes along, but for one; active normals not where they would be wrong."""
    known = kinds_of(before.VTKObject)
    for name, values in before.items():
        is_normal = known.get(name) == "normal"
        if name == kept or (is_normal and not made.carries_normals):
            continue
        after[name] = made.of_points(values, name, known.get(name))
        if name == before.active_texture_coordinates_name:
            after.active_texture_coordinates = after[name]
        if known.get(name) in ("vector", "tensor"):
            activate = after.SetActiveVectors if known[name] == "vector" else after.SetActiveTensors
            activate(name)
        if is_normal:
            after.SetActiveNormals(name)


def _text(name: str, value: str) -> vtkStringArray:
    """PyVista itself makes arrays of ASCII alone; groups such as D∞h are not."""
    array = vtkStringArray()
    array.SetName(name)
    array.InsertNextValue(value)
    return array
