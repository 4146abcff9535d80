"""Data sets of VTK with a known mirror, and what filters make of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

import symsurf

PLANE = symsurf.Plane([1, 2, -0.5], 1.3)


def mirrored_shape(count: int = 300) -> np.ndarray:
    """A lopsided ball beside its reflection over PLANE."""
    x = np.random.default_rng(3).normal(size=(count, 3))
    x /= np.linalg.norm(x, axis=1)[:, None]
    x *= (1 + 0.3 * np.sin(3 * x[:, 0] + x[:, 1]) + 0.2 * x[:, 1] * x[:, 2])[:, None]
    return np.vstack([x, PLANE.reflect(x)])


def polydata(points: np.ndarray) -> vtkPolyData:
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    data = vtkPolyData()
    data.SetPoints(vtk_points)
    return data


BALL_MIRROR = symsurf.Plane([1, 0, 0], 0)


def dented_ball(meridians: int = 24, parallels: int = 15) -> vtkPolyData:
    """A bumpy ball over BALL_MIRROR with a dent in the side of positive x, of quadrangles with
    triangles at the poles. Points have Id, a Mask that is 1 where y is positive, and normals; cells
    have CellId."""
    down, around = np.meshgrid(
        np.pi * (np.arange(parallels) + 1) / (parallels + 1),
        2 * np.pi * (np.arange(meridians) + 0.5) / meridians,
        indexing="ij",
    )
    rings = [np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)]
    u = np.vstack([np.stack(rings, -1).reshape(-1, 3), [(0, 0, 1), (0, 0, -1)]])
    x, y, z = u.T
    dent = 0.1 * np.exp(-((u - (0.8, 0.6, 0)) ** 2).sum(axis=1) / 0.1)
    data = polydata(u * (1 + 0.1 * np.sin(3 * y + 1) + 0.1 * z * x * x - dent)[:, None])

    corner = np.arange(parallels * meridians).reshape(parallels, meridians)
    beside = np.roll(corner, -1, axis=1)
    north, south = len(u) - 2, len(u) - 1
    cells = vtkCellArray()
    for ring in zip(corner[0], beside[0]):
        cells.InsertNextCell(3, (north, *ring))
    for ring in zip(beside[-1], corner[-1]):
        cells.InsertNextCell(3, (south, *ring))
    quads = np.stack([corner[:-1], corner[1:], beside[1:], beside[:-1]], -1).reshape(-1, 4)
    for quad in quads.tolist():
        cells.InsertNextCell(4, quad)
    data.SetPolys(cells)
    for fields, name, values in [
        (data.GetPointData(), "Id", np.arange(len(u))),
        (data.GetPointData(), "Mask", (y > 0).astype(float)),
        (data.GetPointData(), "Normals", u),
        (data.GetCellData(), "CellId", np.arange(data.GetNumberOfCells())),
    ]:
        made = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        made.SetName(name)
        fields.AddArray(made)
    data.GetPointData().SetActiveNormals("Normals")
    return data


def halved(data: vtkPolyData, keep: Any) -> vtkPolyData:
    """The data set without the cells of which a point is not kept, with all its points that are."""
    points = vtk_to_numpy(data.GetPoints().GetData())
    kept = keep(points)
    numbers = np.cumsum(kept) - 1
    made = polydata(points[kept])
    cells = vtkCellArray()
    for i in range(data.GetNumberOfCells()):
        ids = data.GetCell(i).GetPointIds()
        corners = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
        if kept[corners].all():
            cells.InsertNextCell(len(corners), numbers[corners].tolist())
    made.SetPolys(cells)
    for fields, name, count in [
        (made.GetPointData(), "Id", made.GetNumberOfPoints()),
        (made.GetCellData(), "CellId", made.GetNumberOfCells()),
    ]:
        ids = numpy_to_vtk(np.arange(count), deep=True)
        ids.SetName(name)
        fields.AddArray(ids)
    return made


def mirror_data(mirror: symsurf.Mirror) -> vtkPolyData:
    """A mirror as a detection hands it on, its numbers in the field data."""
    from symsurf.vtk.arrays import add_values

    data = vtkPolyData()
    add_values(data.GetFieldData(), {"kind": mirror.kind} | mirror.numbers)
    return data


def array(data: vtkPolyData, name: str) -> np.ndarray:
    """A point array."""
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def error_of(algorithm: Any, event: str = "ErrorEvent") -> str:
    """What the algorithm says, to observers of the event, while it updates."""
    messages: list[str] = []

    def heard(_caller, _event, text):
        messages.append(text)

    heard.CallDataType = "string0"
    tags = [(o, o.AddObserver(event, heard)) for o in (algorithm, algorithm.GetExecutive())]
    algorithm.Update()
    for observed, tag in tags:
        observed.RemoveObserver(tag)
    return "".join(messages)
