"""The filters of symsurf.vtk take every kind of data set that holds a shape."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import symsurf

pytest.importorskip("vtkmodules", reason="needs the vtk package")

from vtk_data import BALL_MIRROR, dented_ball, error_of, halved, mirror_data, polydata
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON,
    VTK_POLYGON,
    vtkCellArray,
    vtkImageData,
    vtkMultiBlockDataSet,
    vtkPolyData,
    vtkTable,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkAppendFilter

from symsurf.vtk import (
    MirrorAsymmetry,
    MirrorDetection,
    MirrorReflection,
    PointDamage,
    SymmetryAnalysis,
)

SPACING = 0.25


def grid_of(data: vtkPolyData) -> vtkUnstructuredGrid:
    append = vtkAppendFilter()
    append.SetInputData(data)
    append.Update()
    return append.GetOutput()


def blocks_of(*data: Any) -> vtkMultiBlockDataSet:
    """Some blocks in a block, beside one that is empty."""
    inner, outer = vtkMultiBlockDataSet(), vtkMultiBlockDataSet()
    for number, each in enumerate(data):
        inner.SetBlock(number, each)
    outer.SetBlock(1, inner)
    return outer


def image_of_a_blob(background: float = 0, blob: float = 1) -> vtkImageData:
    """A lopsided body that is its own image over the plane x = 1."""
    image = vtkImageData()
    image.SetDimensions(25, 21, 17)
    image.SetSpacing(SPACING, SPACING, SPACING)
    image.SetOrigin(1 - 12 * SPACING, -3, -2)
    x, y, z = np.array([image.GetPoint(i) for i in range(image.GetNumberOfPoints())]).T
    inside = (np.abs(x - 1) + 0.4 * y) ** 2 / 4 + (y + 0.3 * z) ** 2 / 3 + (
        z - 0.2 * y * y
    ) ** 2 < 1
    scalars = numpy_to_vtk(np.where(inside, blob, background), deep=True)
    scalars.SetName("body")
    image.GetPointData().SetScalars(scalars)
    return image


def mirror_found(data: Any, **properties: Any) -> tuple[np.ndarray, float]:
    """Of the plane, its normal with x positive."""
    found = MirrorDetection(method="plane", input_data=data, **properties)
    assert error_of(found) == ""
    fields = found.GetOutput(found.MIRROR).GetFieldData()
    assert fields.GetAbstractArray("Verdict").GetValue(0) == "found"
    normal = vtk_to_numpy(fields.GetArray("Normal"))[0]
    sign = np.sign(normal[0])
    return sign * normal, sign * fields.GetArray("Offset").GetValue(0)


def split(data: vtkPolyData) -> list[vtkPolyData]:
    """The halves above and below z = 0; both have the cells' corners beside it."""
    return [halved(data, lambda p: p[:, 2] >= -0.2), halved(data, lambda p: p[:, 2] <= 0.2)]


def test_every_kind_of_mesh_has_the_same_mirror() -> None:
    ball = dented_ball()
    normal, offset = mirror_found(ball)
    for data in (grid_of(ball), blocks_of(ball), blocks_of(grid_of(ball))):
        other, distance = mirror_found(data)
        assert np.allclose(other, normal, atol=1e-6) and distance == pytest.approx(offset, abs=1e-6)


def test_blocks_are_one_shape() -> None:
    """Neither half has this mirror by itself."""
    points = np.random.default_rng(4).normal(size=(400, 3))
    left = points[:, 0] > 0
    halves = [polydata(points[left]), polydata(points[left] * (-1, 1, 1))]
    normal, offset = mirror_found(blocks_of(*halves))
    assert np.allclose(normal, (1, 0, 0), atol=1e-9) and abs(offset) < 1e-9


def test_of_bodies_the_surface_counts() -> None:
    """A box of hexahedra, with a point in the middle that no face has."""
    x = np.stack(np.meshgrid(*[np.linspace(0, size, 3) for size in (1, 2, 3)], indexing="ij"), -1)
    numbers = np.arange(27).reshape(3, 3, 3)
    grid = vtkUnstructuredGrid()
    grid.SetPoints(polydata(x.reshape(-1, 3)).GetPoints())
    corners = [
        (0, 0, 0),
        (1, 0, 0),
        (1, 1, 0),
        (0, 1, 0),
        (0, 0, 1),
        (1, 0, 1),
        (1, 1, 1),
        (0, 1, 1),
    ]
    for cell in np.ndindex(2, 2, 2):
        ids = vtkIdList()
        for corner in corners:
            ids.InsertNextId(int(numbers[tuple(np.add(cell, corner))]))
        grid.InsertNextCell(VTK_HEXAHEDRON, ids)
    detection = MirrorDetection(method="plane", input_data=grid)
    assert error_of(detection) == ""
    shape = detection.output
    assert (shape.GetNumberOfPoints(), shape.GetNumberOfPolys()) == (26, 24)


def test_a_grid_without_cells_is_its_points() -> None:
    grid = vtkUnstructuredGrid()
    points = dented_ball().GetPoints()
    grid.SetPoints(points)
    reflection = MirrorReflection(input_data=grid, mirror_data=mirror_data(BALL_MIRROR))
    assert error_of(reflection) == ""
    images = BALL_MIRROR.reflect(vtk_to_numpy(points.GetData()))
    assert np.array_equal(vtk_to_numpy(reflection.output.GetPoints().GetData()), images)


@pytest.mark.parametrize(
    ("algorithm", "options"),
    [(MirrorAsymmetry, {"method": "plane"}), (PointDamage, {}), (SymmetryAnalysis, {})],
)
def test_what_other_filters_make_of_a_grid_is_poly_data(algorithm: type, options: dict) -> None:
    ball = dented_ball()
    of_ball, of_grid = (algorithm(input_data=each, **options) for each in (ball, grid_of(ball)))
    for each in (of_ball, of_grid):
        assert error_of(each) == ""
    assert of_grid.output.GetNumberOfCells() == of_ball.output.GetNumberOfCells()
    ids = [vtk_to_numpy(each.output.GetPointData().GetArray("Id")) for each in (of_ball, of_grid)]
    assert np.array_equal(np.sort(ids[1]), np.sort(ids[0]))


def test_of_an_image_the_points_above_the_threshold_count() -> None:
    normal, offset = mirror_found(image_of_a_blob())
    assert np.allclose(normal, (1, 0, 0), atol=1e-9) and offset == pytest.approx(-1, abs=1e-9)
    image = image_of_a_blob(-1000, 300)
    other, distance = mirror_found(image, image_threshold=299)
    assert np.array_equal(other, normal) and distance == offset
    above = MirrorDetection(method="plane", input_data=image, image_threshold=300)
    assert "0 points" in error_of(above)


def test_the_scalars_of_an_image_can_be_chosen() -> None:
    image = image_of_a_blob()
    noise = numpy_to_vtk(
        np.random.default_rng(1).uniform(size=image.GetNumberOfPoints()), deep=True
    )
    noise.SetName("noise")
    image.GetPointData().AddArray(noise)
    image.GetPointData().SetActiveScalars("noise")
    detection = MirrorDetection(method="plane", input_data=image)
    detection.SetInputArrayToProcess(0, 0, 0, 0, "body")
    assert error_of(detection) == ""
    body = vtk_to_numpy(image.GetPointData().GetArray("body"))
    assert detection.output.GetNumberOfPoints() == body.sum()


def test_what_is_no_shape_is_an_error() -> None:
    detection = MirrorDetection(method="plane")
    image = image_of_a_blob()
    image.GetPointData().SetActiveScalars(None)
    vectors = image_of_a_blob()
    vectors.GetPointData().SetScalars(numpy_to_vtk(np.zeros((vectors.GetNumberOfPoints(), 3))))
    ids = vtkIdList()
    for number in (0, 1, 100000):
        ids.InsertNextId(number)
    broken = vtkUnstructuredGrid()
    broken.SetPoints(dented_ball().GetPoints())
    broken.InsertNextCell(VTK_POLYGON, ids)
    for data, said in [
        (vtkTable(), "the input is a vtkTable; allowed are vtkPolyData and other point sets"),
        (blocks_of(dented_ball(), vtkTable()), "the input is a vtkTable"),
        (image, "has no point scalars that are active"),
        (vectors, "have 3 components; allowed is one"),
        (broken, "a cell names point 100000"),
        (vtkMultiBlockDataSet(), "0 points"),
    ]:
        detection.SetInputDataObject(data)
        assert said in error_of(detection)
        assert detection.output.GetNumberOfPoints() == 0
    detection.SetInputDataObject(dented_ball())
    assert error_of(detection) == ""


@pytest.mark.parametrize("point", [-1, 362, 10**9])
@pytest.mark.parametrize("kind", ["Verts", "Lines", "Polys", "Strips"])
def test_every_cell_names_points_that_are_there(kind: str, point: int) -> None:
    ball = dented_ball()
    cells = vtkCellArray()
    cells.DeepCopy(getattr(ball, f"Get{kind}")())
    cells.InsertNextCell(3, (0, 1, point))
    getattr(ball, f"Set{kind}")(cells)
    for data in (ball, blocks_of(dented_ball(), ball)):
        for algorithm in (MirrorDetection, MirrorAsymmetry, PointDamage, SymmetryAnalysis):
            said = error_of(algorithm(input_data=data))
            assert f"a cell names point {point}; allowed is 0 to 361" in said


def test_symsurf_detect_sees_the_same_points() -> None:
    image = image_of_a_blob()
    inside = vtk_to_numpy(image.GetPointData().GetScalars()) > 0.5
    points = np.array([image.GetPoint(i) for i in np.flatnonzero(inside)])
    result = symsurf.detect(points, "plane")
    normal, _ = mirror_found(image)
    assert np.allclose(normal, np.sign(result.mirror.normal[0]) * result.mirror.normal)
