"""Reflection, samples and damage in the vtk package that pip installs."""

from __future__ import annotations

import numpy as np
import pytest

import symsurf

pytest.importorskip("vtkmodules", reason="needs the vtk package")

from bad_input import tables
from vtk_data import (
    BALL_MIRROR,
    array,
    dented_ball,
    error_of,
    mirror_data,
    mirrored_shape,
    polydata,
)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from symsurf import _core
from symsurf.vtk import (
    MirrorAsymmetry,
    MirrorDetection,
    MirrorReflection,
    MirrorSampleSource,
    PointDamage,
    SymmetryAnalysis,
)
from symsurf.vtk.arrays import add_values


def points_of(data: vtkPolyData) -> np.ndarray:
    return vtk_to_numpy(data.GetPoints().GetData())


def corners_of(data: vtkPolyData, cell: int) -> list[int]:
    ids = data.GetCell(cell).GetPointIds()
    return [ids.GetId(k) for k in range(ids.GetNumberOfIds())]


def normal_of_first_cell(data: vtkPolyData) -> np.ndarray:
    a, b, c = points_of(data)[corners_of(data, 0)[:3]]
    return np.cross(b - a, c - a)


def test_reflection_lies_on_the_partners() -> None:
    detection = MirrorDetection(method="plane", input_data=polydata(mirrored_shape()))
    reflection = MirrorReflection()
    reflection.SetInputConnection(detection.GetOutputPort())
    reflection.SetMirrorConnection(detection.GetOutputPort(MirrorDetection.MIRROR))
    assert error_of(reflection) == ""
    partners = array(reflection.output, "MirrorPartner")
    gaps = points_of(reflection.output) - points_of(detection.GetInput())[partners]
    residuals = array(reflection.output, "MirrorResidual")
    paired = partners >= 0
    assert paired.all() and np.allclose(np.linalg.norm(gaps, axis=1), residuals, atol=1e-12)


def test_reflection_keeps_the_outside_out() -> None:
    ball = dented_ball()
    reflection = MirrorReflection(input_data=ball, mirror_data=mirror_data(BALL_MIRROR))
    reflection.Update()
    made = reflection.output
    assert np.array_equal(points_of(made), BALL_MIRROR.reflect(points_of(ball)))
    normals = [vtk_to_numpy(data.GetPointData().GetNormals()) for data in (ball, made)]
    np.testing.assert_allclose(normals[1], normals[0] * (-1, 1, 1), atol=1e-9)
    outwards = [normal_of_first_cell(data) @ points_of(data)[0] for data in (ball, made)]
    assert np.sign(outwards[0]) == np.sign(outwards[1]) != 0
    assert np.array_equal(array(made, "Id"), array(ball, "Id"))


def test_reflection_leaves_out_what_has_no_image() -> None:
    ball = dented_ball()
    sphere = symsurf.Sphere([0.9, 0, 0], 0.5)
    reflection = MirrorReflection(input_data=ball, mirror_data=mirror_data(sphere))
    reflection.Update()
    images = sphere.reflect(points_of(ball))
    kept = np.isfinite(images).all(axis=1)
    assert 0 < kept.sum() < len(kept)
    made = reflection.output
    assert np.array_equal(points_of(made), images[kept])
    assert np.array_equal(array(made, "Id"), np.flatnonzero(kept))
    cells = [corners_of(ball, i) for i in range(ball.GetNumberOfCells())]
    whole = [i for i, corners in enumerate(cells) if kept[corners].all()]
    ids = vtk_to_numpy(made.GetCellData().GetArray("CellId"))
    assert np.array_equal(ids, whole)
    for i, source in enumerate(whole):
        assert set(np.flatnonzero(kept)[corners_of(made, i)]) == set(cells[source])


def test_reflection_needs_a_mirror() -> None:
    reflection = MirrorReflection(input_data=dented_ball())
    assert "0 connections" in error_of(reflection)
    for row in tables.mirrors():
        data = vtkPolyData()
        add_values(data.GetFieldData(), {"kind": row.kind} | row.numbers)
        reflection.mirror_data = data
        assert row.reason in error_of(reflection), row.name
        assert reflection.output.GetNumberOfPoints() == 0
    reflection.mirror_data = mirror_data(BALL_MIRROR)
    assert error_of(reflection) == ""


def test_a_mirror_is_no_shape_and_a_shape_no_mirror() -> None:
    detection = MirrorDetection(method="plane", input_data=polydata(mirrored_shape()))
    mirror = detection.GetOutputPort(detection.MIRROR)
    made = [MirrorDetection, MirrorReflection, MirrorAsymmetry, SymmetryAnalysis, PointDamage]
    for filter_ in [each() for each in (*made, MirrorSampleSource)]:
        if isinstance(filter_, MirrorReflection):
            filter_.SetMirrorConnection(mirror)
        filter_.SetInputConnection(mirror)
        assert "the input is a mirror" in error_of(filter_)
        assert filter_.output.GetNumberOfPoints() == 0
        filter_.SetInputConnection(detection.GetOutputPort())
        assert error_of(filter_) == ""
    reflection = MirrorReflection(input_data=polydata(mirrored_shape()))
    reflection.SetMirrorConnection(detection.GetOutputPort())
    assert "is the shape of a mirror detection; connect output 1" in error_of(reflection)


@pytest.mark.parametrize("generator", _core.generators())
def test_samples_are_what_the_generators_give(generator: str) -> None:
    given = np.random.default_rng(2).normal(size=(50, 3))
    source = MirrorSampleSource(generator=generator)
    mirrors_points = _core.generators()[generator].mirrors_points
    if mirrors_points:
        source.input_data = polydata(given)
    assert error_of(source) == ""
    points, _truth, pairs, _ = _core.generate(generator, {}, given if mirrors_points else None)
    sample, mirror = source.GetOutput(source.SAMPLE), source.GetOutput(source.MIRROR)
    assert np.array_equal(points_of(sample), points)
    assert sample.GetNumberOfVerts() == len(points)
    partners = array(sample, "MirrorPartner")
    assert np.array_equal(partners[pairs[:, 0]], pairs[:, 1])
    assert np.array_equal(partners[pairs[:, 1]], pairs[:, 0])
    assert mirror.GetNumberOfPolys() > 0
    reflection = MirrorReflection(input_data=sample)
    reflection.SetMirrorConnection(source.GetOutputPort(source.MIRROR))
    assert error_of(reflection) == ""
    apart = points_of(reflection.output)[pairs[:, 0]] - points[pairs[:, 1]]
    assert np.abs(apart).max() < 1e-6 * np.ptp(points)


@pytest.mark.parametrize("damage", _core.damages())
def test_damage_is_what_the_core_does(damage: str) -> None:
    ball = dented_ball()
    damaged = PointDamage(damage=damage, seed=3, input_data=ball)
    assert error_of(damaged) == ""
    points, kept = _core.damage(damage, points_of(ball), {}, 3)
    assert np.array_equal(points_of(damaged.output), points)
    assert np.array_equal(array(damaged.output, "Id"), kept)
    assert damaged.output.GetPointData().GetNormals() is None
    named = vtk_to_numpy(damaged.output.GetPolys().GetConnectivityArray())
    assert (named < len(points)).all()


def test_a_hole_takes_the_cells_that_need_its_points() -> None:
    ball = dented_ball()
    damaged = PointDamage(damage="removal", removal_probability=0.1, seed=1, input_data=ball)
    assert error_of(damaged) == ""
    kept = set(array(damaged.output, "Id").tolist())
    cells = [corners_of(ball, i) for i in range(ball.GetNumberOfCells())]
    whole = [i for i, corners in enumerate(cells) if kept.issuperset(corners)]
    assert 0 < len(whole) < len(cells)
    ids = vtk_to_numpy(damaged.output.GetCellData().GetArray("CellId"))
    assert np.array_equal(ids, whole)


@pytest.mark.parametrize(
    ("algorithm", "selector", "descriptions"),
    [
        (MirrorSampleSource, "generator", _core.generators()),
        (PointDamage, "damage", _core.damages()),
    ],
)
def test_numbers_out_of_range(algorithm: type, selector: str, descriptions: dict) -> None:
    for name, described in descriptions.items():
        found = algorithm(**{selector: name, "input_data": dented_ball()})
        for parameter, value in tables.numbers_out_of_range(described.parameters):
            setattr(found, f"{name}_{parameter.name}", value)
            assert f"{parameter.name} is " in error_of(found)
            assert found.output.GetNumberOfPoints() == 0
            setattr(found, f"{name}_{parameter.name}", parameter.default)
    setattr(found, selector, "no such")
    assert "'no such'" in error_of(found)
