"""Scenes of 3D Slicer, run with slicer-core: scenes.py NAME prints what the function gives as JSON."""

from __future__ import annotations

import json
import runpy
import sys
from typing import Any

import numpy as np
from MirrorSymmetryLib import Outputs, SymmetryLogic
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4

import slicer
import symsurf

SCENE = slicer.vtkMRMLScene()
LOGIC = SymmetryLogic()
SEGMENTATIONS = slicer.vtkSlicerSegmentationsModuleLogic()  # knows how labels become surfaces
SEGMENTATIONS.SetMRMLScene(SCENE)
ACROSS = 5.0
"""Where the mirror of ``head`` lies, R = 5 mm."""


def head(bump: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of a bent ellipsoid of some 60 mm; with a bump on its right, mm."""
    longitude, latitude = np.meshgrid(np.arange(60) * np.pi / 30, np.linspace(0.03, 3.11, 40))
    ring = np.sin(latitude)
    points = np.stack([ring * np.cos(longitude), ring * np.sin(longitude), np.cos(latitude)], -1)
    points = points.reshape(-1, 3)
    swollen = np.exp(-40 * np.square(points - (0.8, 0.6, 0)).sum(axis=1))
    points = points * (20, 30, 25) * (1 + bump / 30 * swollen[:, None])
    points[:, 2] += 0.01 * (points[:, 1] + 10) ** 2
    corner = np.arange(39 * 60).reshape(39, 60)
    right = np.roll(corner, -1, axis=1)
    faces = [(corner, right + 60, right), (corner, corner + 60, right + 60)]
    triangles = np.concatenate([np.stack(each, -1).reshape(-1, 3) for each in faces])
    return points + (ACROSS, -100, 40), triangles


def turn() -> np.ndarray:
    """(4, 4): 20 degrees about S, then 10 about A, then a shift, mm."""
    c, s = np.cos(np.radians((20, 10))), np.sin(np.radians((20, 10)))
    about_s = np.array([[c[0], -s[0], 0], [s[0], c[0], 0], [0, 0, 1]])
    about_a = np.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]])
    matrix = np.eye(4)
    matrix[:3, :3] = about_a @ about_s
    matrix[:3, 3] = 7, 8, 9
    return matrix


def surface(points: np.ndarray, triangles: np.ndarray) -> vtkPolyData:
    made, vertices, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    vertices.SetData(numpy_to_vtk(points, deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True))
    made.SetPoints(vertices)
    made.SetPolys(cells)
    return made


def new(kind: str, name: str = "") -> Any:
    return SCENE.AddNewNodeByClass(f"vtkMRML{kind}Node", name or kind)


def model(bump: float = 0.0, name: str = "Head") -> Any:
    node = new("Model", name)
    node.SetAndObservePolyData(surface(*head(bump)))
    return node


def transform(matrix: np.ndarray) -> Any:
    node, elements = new("LinearTransform"), vtkMatrix4x4()
    elements.DeepCopy(matrix.ravel())
    node.SetMatrixTransformToParent(elements)
    return node


def matrix_of(node: Any) -> np.ndarray:
    elements = vtkMatrix4x4()
    node.GetMatrixTransformToParent(elements)
    return np.array([[elements.GetElement(i, j) for j in range(4)] for i in range(4)])


def plane_of(node: Any) -> dict[str, Any]:
    normal = [0.0, 0.0, 0.0]
    node.GetNormalWorld(normal)
    return {"normal": normal, "centre": node.GetCenterWorld(), "size": node.GetSizeWorld()}


def columns_of(node: Any) -> dict[str, list[Any]]:
    table = node.GetTable()
    found = {}
    for number in range(table.GetNumberOfColumns()):
        array = table.GetColumn(number)
        values = [array.GetValue(row) for row in range(array.GetNumberOfValues())]
        found[array.GetName()] = [
            None if isinstance(value, float) and np.isnan(value) else value for value in values
        ]
    return found


def error_of(call: Any) -> str:
    try:
        call()
    except ValueError as error:
        return str(error)
    return ""


def of_a_model(turned: str = "") -> dict[str, Any]:
    """Plane and transform; turned: of a model under a transform."""
    node = model()
    if turned:
        node.SetAndObserveTransformNodeID(transform(turn()).GetID())
    outputs = Outputs(
        plane=new("MarkupsPlane"), transform=new("LinearTransform"), mirror=new("Model")
    )
    result = LOGIC.process(node, outputs)
    return {
        "verdict": result.verdict,
        "plane": plane_of(outputs.plane),
        "matrix": matrix_of(outputs.transform).tolist(),
        "to_world": (turn() if turned else np.eye(4)).tolist(),
        "mirror_cells": outputs.mirror.GetPolyData().GetNumberOfPolys(),
    }


def of_a_segmentation() -> dict[str, Any]:
    """Of labels, two segments: a bent ellipsoid whose mirror is R = 3, and another one."""
    s, a, r = np.mgrid[-30:30, -30:30, -30:30]
    node = new("Segmentation")
    for name, middle in (("bone", 3), ("other", -4)):
        image = slicer.vtkOrientedImageData()
        image.SetDimensions(60, 60, 60)
        image.SetOrigin(-30, -30, -30)
        image.AllocateScalars(VTK_UNSIGNED_CHAR, 1)
        labels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(60, 60, 60)
        inside = ((r - middle) / 14) ** 2 + (a / 22) ** 2 + ((s - 0.02 * (a + 9) ** 2 + 5) / 9) ** 2
        labels[:] = inside < 1
        node.AddSegmentFromBinaryLabelmapRepresentation(image, name, (1, 0, 0))
    plane = new("MarkupsPlane")
    LOGIC.process(node, Outputs(plane=plane), segment="bone")
    return {
        "plane": plane_of(plane),
        "none": error_of(lambda: LOGIC.process(node, Outputs())),
        "unknown": error_of(lambda: LOGIC.process(node, Outputs(), segment="skin")),
    }


def with_holes() -> dict[str, Any]:
    """A model of which some points are not finite."""
    points, triangles = head()
    points[[1000, 1001, 1500]] = np.nan
    node, outputs = new("Model", "Scan"), Outputs(plane=new("MarkupsPlane"), asymmetry=new("Model"))
    node.SetAndObservePolyData(surface(points, triangles))
    LOGIC.process(node, outputs, use_faces=False)
    made = outputs.asymmetry.GetPolyData()
    return {
        "plane": plane_of(outputs.plane),
        "points": made.GetNumberOfPoints() - len(points),
        "cells": made.GetNumberOfCells() - len(triangles),
        "given": node.GetPolyData().GetNumberOfPoints() - len(points),
    }


def coloured() -> dict[str, Any]:
    """A bump of 3 mm on one side, and the same shape again."""
    node, outputs = model(3.0), Outputs(asymmetry=new("Model"))
    LOGIC.process(node, outputs)
    data = outputs.asymmetry.GetPolyData().GetPointData()
    names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
    signed = vtk_to_numpy(data.GetArray("signed"))
    right = head()[0][:, 0] > ACROSS
    again = Outputs(asymmetry=new("Model"))
    LOGIC.process(node, again)
    display = outputs.asymmetry.GetDisplayNode()
    colours = display.GetColorNode()
    return {
        "names": names,
        "given": node.GetPolyData().GetPointData().GetNumberOfArrays(),
        "least_right": float(np.nanmin(signed[right])),
        "greatest_left": float(np.nanmax(signed[~right])),
        "range": display.GetScalarRange(),
        "shown": [display.GetScalarVisibility(), display.GetActiveScalarName()],
        "same_colours": again.asymmetry.GetDisplayNode().GetColorNodeID() == colours.GetID(),
        "ends": [colours.GetLookupTable().GetTableValue(i)[:3] for i in (0, 127, 254)],
    }


def landmarks() -> dict[str, Any]:
    """One of a pair lies 2 mm too far back, one landmark lacks its pair."""
    given = new("MarkupsFiducial", "given")
    places = {
        "eye_l": (ACROSS - 10, -80, 40),
        "eye_r": (ACROSS + 10, -82, 40),
        "nose": (ACROSS, -70, 40),
        "ear_l": (ACROSS - 20, -100, 40),
    }
    for name, place in places.items():
        given.AddControlPointWorld(place, name)
    given.AddControlPointWorld((0, 0, 0), "lost")
    given.UnsetNthControlPointPosition(given.GetNumberOfControlPoints() - 1)
    outputs = Outputs(landmarks=new("MarkupsFiducial"), landmark_table=new("Table"))
    LOGIC.process(model(), outputs, landmarks=given)
    made = outputs.landmarks
    return {
        "table": columns_of(outputs.landmark_table),
        "points": {
            made.GetNthControlPointLabel(i): made.GetNthControlPointPositionWorld(i)
            for i in range(made.GetNumberOfControlPoints())
        },
        "descriptions": [
            made.GetNthControlPointDescription(i) for i in range(made.GetNumberOfControlPoints())
        ],
        "none": error_of(lambda: LOGIC.process(model(), outputs)),
    }


def table() -> dict[str, Any]:
    """Two shapes, the first twice."""
    outputs = Outputs(table=new("Table"))
    for bump, name in ((5, "Swollen"), (0, "Even"), (3, "Swollen")):
        LOGIC.process(model(bump, name), outputs)
    return columns_of(outputs.table)


def symmetries() -> dict[str, Any]:
    """All planes and axes of a box that lies turned."""
    corners = np.array([[x, y, z] for x in (-2, 2) for y in (-3, 3) for z in (-5, 5)], float)
    triangles = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)]
    triangles += [(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    node = new("Model", "Box")
    node.SetAndObservePolyData(surface(corners, np.array(triangles)))
    node.SetAndObserveTransformNodeID(transform(turn()).GetID())
    outputs = Outputs(symmetries=new("Table"), table=new("Table"))
    LOGIC.process(node, outputs)
    return {
        "elements": columns_of(outputs.symmetries),
        "figures": columns_of(outputs.table),
        "to_world": turn().tolist(),
    }


def plate() -> Any:
    """Flat, of uneven triangles: bent mirrors across it move nothing."""
    count, rng = 45, np.random.default_rng(0)
    at = np.stack(np.meshgrid(np.arange(count), np.arange(count)), -1).reshape(-1, 2)
    points = np.column_stack([at + rng.uniform(-0.4, 0.4, at.shape), rng.normal(size=len(at)) / 50])
    corner = np.arange(count**2).reshape(count, count)[:-1, :-1].ravel()
    triangles = [
        (corner, corner + 1, corner + count + 1),
        (corner, corner + count + 1, corner + count),
    ]
    node = new("Model", "Plate")
    node.SetAndObservePolyData(surface(points, np.vstack([np.column_stack(t) for t in triangles])))
    return node


def refused() -> list[str]:
    empty = new("Model", "Empty")
    return [
        error_of(lambda: LOGIC.process(None, Outputs())),
        error_of(lambda: LOGIC.process(empty, Outputs())),
        error_of(lambda: LOGIC.process(new("MarkupsFiducial", "Points"), Outputs())),
        error_of(lambda: LOGIC.process(model(), Outputs(), method="mirror")),
        error_of(lambda: LOGIC.process(model(), Outputs(), parameters={"tolerance": 7})),
        error_of(
            lambda: LOGIC.process(
                plate(), Outputs(plane=new("MarkupsPlane")), method="perpendicular"
            )
        ),
    ]


def cancelled() -> dict[str, Any]:
    plane, fractions = new("MarkupsPlane"), []
    try:
        LOGIC.process(model(), Outputs(plane=plane), progress=lambda f: bool(fractions.append(f)))
    except symsurf.Cancelled:
        return {"calls": len(fractions), "points": plane.GetNumberOfControlPoints()}
    return {}


def curved() -> dict[str, Any]:
    """A plate bent about an axis along S, whose mirror is a cylinder of radius 50 mm about R = -50."""
    angle, height = np.meshgrid(np.linspace(-0.8, 0.8, 80), np.linspace(0, 40, 60))
    wave = 4 + np.cos(5 * angle) * np.sin(height / 6)
    sheets = [
        np.stack([r * np.cos(angle) - 50, r * np.sin(angle), height], -1).reshape(-1, 3)
        for r in (50 + wave, 50 - wave)
    ]
    points = np.concatenate(sheets)
    node, outputs = new("Model", "Plate"), Outputs(plane=new("MarkupsPlane"), mirror=new("Model"))
    data = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetData(numpy_to_vtk(points, deep=True))
    data.SetPoints(vertices)
    node.SetAndObservePolyData(data)
    result = LOGIC.process(node, outputs, method="cylinder")
    mirror = vtk_to_numpy(outputs.mirror.GetPolyData().GetPoints().GetData())
    radii = np.hypot(mirror[:, 0] + 50, mirror[:, 1])
    return {
        "kind": result.mirror.kind,
        "radii": [float(radii.min()), float(radii.max())],
        "plane": plane_of(outputs.plane),
    }


def example(path: str) -> dict[str, Any]:
    """Runs a script as Slicer's Python console would, in a scene with two models."""
    slicer.mrmlScene = SCENE
    model(5, "Swollen"), model(0, "Even")
    runpy.run_path(path)
    kinds = ("MarkupsPlane", "LinearTransform", "Model", "Table")
    return {kind: SCENE.GetNumberOfNodesByClass(f"vtkMRML{kind}Node") for kind in kinds}


if __name__ == "__main__":
    print(json.dumps(globals()[sys.argv[1]](*sys.argv[2:]), default=list))
