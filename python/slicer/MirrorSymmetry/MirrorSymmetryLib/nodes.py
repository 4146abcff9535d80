"""Nodes of the scene, made from what symsurf finds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataObject, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4

import slicer

COLOURS = "MirrorAsymmetry"
"""The singleton tag and name of the colour node."""

# Blue over light grey to red, ColorBrewer's RdBu without its ends: too far out, even, too far in.
_BLUE, _EVEN, _RED = (0.13, 0.40, 0.67), (0.97, 0.97, 0.97), (0.70, 0.09, 0.17)
_UNMATCHED = (0.5, 0.5, 0.5, 1.0)
_COUNT = 255  # colours, odd so that one stands for 0


def set_plane(
    node: slicer.vtkMRMLMarkupsPlaneNode, mirror: Any, points: NDArray[np.float64]
) -> None:
    """Lays the plane over the part of the mirror plane that lies inside the points (n, 3)."""
    corners, _ = mirror.mesh(points, resolution=1)
    across, along = corners[1] - corners[0], corners[2] - corners[0]
    sizes = [float(np.linalg.norm(side)) for side in (across, along)]
    axes = [across / sizes[0], along / sizes[1]]
    node.SetSizeMode(node.SizeModeAbsolute)
    node.SetAxesWorld(*axes, np.cross(*axes))
    node.SetCenterWorld(corners.mean(axis=0))
    node.SetSizeWorld(*sizes)
    if np.dot(np.cross(*axes), mirror.normal) < 0:
        node.FlipNormal()


def set_matrix(node: slicer.vtkMRMLLinearTransformNode, matrix: NDArray[np.float64]) -> None:
    """(4, 4), to the node's parent."""
    elements = vtkMatrix4x4()
    elements.DeepCopy(matrix.ravel())
    node.SetMatrixTransformToParent(elements)


def set_mesh(
    node: slicer.vtkMRMLModelNode, points: NDArray[np.float64], triangles: NDArray[np.int64]
) -> None:
    """Points (n, 3) and triangles (m, 3)."""
    vertices = vtkPoints()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(triangles).ravel(), deep=True))
    surface = vtkPolyData()
    surface.SetPoints(vertices)
    surface.SetPolys(cells)
    node.SetAndObservePolyData(surface)
    node.CreateDefaultDisplayNodes()


def set_coloured_model(
    node: slicer.vtkMRMLModelNode, surface: vtkPolyData, scalars: str, limit: float
) -> None:
    """Shows the surface in the colours of a point array, from -limit to limit."""
    node.SetAndObservePolyData(surface)
    node.CreateDefaultDisplayNodes()
    display = node.GetDisplayNode()
    display.SetActiveScalar(scalars, vtkDataObject.POINT)
    display.SetAndObserveColorNodeID(_colours(node.GetScene()).GetID())
    display.SetScalarRangeFlag(display.UseManualScalarRange)
    display.SetScalarRange(-limit, limit)
    display.SetScalarVisibility(True)


def set_table(node: slicer.vtkMRMLTableNode, columns: Mapping[str, Iterable[Any]]) -> None:
    """A column of texts or numbers each, in place of those that are there."""
    node.RemoveAllColumns()
    for name, values in columns.items():
        rows = list(values)
        column = vtkStringArray() if any(isinstance(row, str) for row in rows) else vtkDoubleArray()
        for row in rows:
            column.InsertNextValue(row)
        column.SetName(name)
        node.AddColumn(column)


def set_row(node: slicer.vtkMRMLTableNode, name: str, values: Mapping[str, Any]) -> None:
    """Texts and numbers, a column each, in the row whose first column, Shape, has this name: the one
    that is there, or a new one."""
    table = node.GetTable()
    names = table.GetColumnByName("Shape")
    known = [names.GetValue(i) for i in range(table.GetNumberOfRows())] if names else []
    row = known.index(name) if name in known else len(known)
    for column, value in {"Shape": name, **values}.items():
        array = table.GetColumnByName(column) or _new_column(node, column, value, len(known))
        if row == array.GetNumberOfValues():
            array.InsertNextValue(value)
        else:
            array.SetValue(row, value)
    for number in range(table.GetNumberOfColumns()):
        array = table.GetColumn(number)
        if array.GetNumberOfValues() <= row:  # a figure that this shape has not
            array.InsertNextValue("" if array.IsA("vtkStringArray") else np.nan)
    node.Modified()


def _new_column(node: slicer.vtkMRMLTableNode, name: str, value: Any, rows: int) -> Any:
    text = isinstance(value, str)
    array = vtkStringArray() if text else vtkDoubleArray()
    array.SetName(name)
    for _ in range(rows):
        array.InsertNextValue("" if text else np.nan)
    node.AddColumn(array)
    return node.GetTable().GetColumnByName(name)


def set_points(
    node: slicer.vtkMRMLMarkupsFiducialNode,
    points: NDArray[np.float64],
    labels: Iterable[str],
    descriptions: Iterable[str],
) -> None:
    """Points (k, 3) in world coordinates, in place of those that are there; those not finite are
    defined, but have no position."""
    node.RemoveAllControlPoints()
    for point, label, description in zip(points, labels, descriptions, strict=True):
        number = node.AddControlPointWorld(np.nan_to_num(point), label)
        node.SetNthControlPointDescription(number, description)
        if not np.isfinite(point).all():
            node.UnsetNthControlPointPosition(number)


def points_of(node: slicer.vtkMRMLMarkupsNode) -> tuple[NDArray[np.float64], list[str]]:
    """Control points (k, 3) in world coordinates, and their labels; those without a position are left
    out."""
    numbers = [
        i
        for i in range(node.GetNumberOfControlPoints())
        if node.GetNthControlPointPositionStatus(i) == node.PositionDefined
    ]
    points = np.zeros((len(numbers), 3))
    for row, number in zip(points, numbers, strict=True):
        node.GetNthControlPointPositionWorld(number, row)
    return points, [node.GetNthControlPointLabel(number) for number in numbers]


def _colours(scene: slicer.vtkMRMLScene) -> slicer.vtkMRMLColorTableNode:
    """The colour node of signed asymmetries: one a scene."""
    node = scene.GetSingletonNode(COLOURS, "vtkMRMLColorTableNode")
    if node is not None:
        return node
    node = slicer.vtkMRMLColorTableNode()
    node.SetSingletonTag(COLOURS)
    node.SetTypeToUser()
    node.SetName(COLOURS)
    node.SetNumberOfColors(_COUNT)
    for number, place in enumerate(np.linspace(-1, 1, _COUNT)):
        end = np.array(_BLUE if place < 0 else _RED)
        node.SetColor(number, *(abs(place) * end + (1 - abs(place)) * np.array(_EVEN)))
    node.GetLookupTable().SetNanColor(_UNMATCHED)
    return scene.AddNode(node)
