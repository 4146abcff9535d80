"""Detections, operations and analyses give results that are used alike."""

from __future__ import annotations

import inspect
import json

import numpy as np
import pytest

import symsurf

PLANE = symsurf.Plane((1, 0, 0), 0.5)


@pytest.fixture(scope="module")
def shape():
    half = np.random.default_rng(2).normal(size=(150, 3)) + (1.5, 0, 0)
    return symsurf.Shape(np.vstack([half, half * (-1, 1, 1)]) - (0.5, 0, 0))


FAMILIES = {
    "detection": lambda shape: symsurf.match(shape, PLANE),
    "operation": lambda shape: symsurf.asymmetry(shape, PLANE),
    "analysis": lambda shape: symsurf.symmetry_embedding(shape),
}


@pytest.fixture(params=FAMILIES)
def result(request, shape):
    return FAMILIES[request.param](shape)


def test_all_have_the_same_members(result, shape, tmp_path):
    np.testing.assert_array_equal(result.shape.points, shape.points)
    assert all(len(values) == len(shape.points) for values in result.arrays.values())
    assert result.arrays and result.parameters and result.statistics and result.seconds > 0
    record = json.loads(json.dumps(result.to_json(), allow_nan=False))
    assert {"parameters", "statistics", "seconds"} <= record.keys()
    result.save(tmp_path / "result.json")
    saved = json.loads((tmp_path / "result.json").read_text())
    assert record.items() <= saved.items()
    pyvista = pytest.importorskip("pyvista")
    mesh = result.like(pyvista.PolyData(shape.points))
    for name, values in result.arrays.items():
        np.testing.assert_array_equal(mesh[name], values)
    result.plot(tmp_path / "result.png")
    assert (tmp_path / "result.png").stat().st_size > 1000


def test_arrays_of_a_detection_are_its_pairs(shape):
    found = symsurf.match(shape, PLANE)
    first, second = found.pairs.T
    np.testing.assert_array_equal(found.arrays["partner"][first], second)
    np.testing.assert_array_equal(found.arrays["residual"][first], found.residuals)
    assert np.count_nonzero(found.arrays["partner"] >= 0) == len(found.pairs)
    with pytest.raises(symsurf.InvalidInput, match="the result has no points"):
        _ = symsurf.Result.from_fields(vars(found) | {"points": None}).arrays


def test_what_matters_is_printed_first(shape):
    words = list(symsurf.asymmetry(shape, PLANE).summary)
    assert words[2:6] == ["rms", "mean", "maximum", "matched share"]


def test_a_shape_is_an_array_of_its_points(shape):
    assert np.asarray(shape) is shape.points
    assert np.array(shape, np.float32).dtype == np.float32
    mesh = symsurf.Shape(shape.points[:3], np.array([[0, 1, 2]]))
    assert isinstance(PLANE.reflect(mesh), symsurf.Shape)
    assert symsurf.correspondences(mesh, PLANE).shape.faces is not None


def test_arguments_have_the_same_names(shape):
    for name in ("detect", *(f"detect_{method}" for method in symsurf.methods())):
        assert next(iter(inspect.signature(getattr(symsurf, name)).parameters)) == "shape"
    found = symsurf.detect(points=shape, method="plane")  # the name of before
    assert symsurf.detect_plane(points=shape).score == found.score
    first = symsurf.asymmetry(shape, result=found)
    np.testing.assert_array_equal(first.distance, symsurf.asymmetry(shape, mirror=found).distance)


def test_choices_are_typed():
    axis = inspect.signature(symsurf.align).parameters["axis"]
    assert axis.annotation == "Literal['x', 'y', 'z']"


def test_the_offset_of_a_plane_has_the_sign_that_is_documented():
    plane = symsurf.Plane((0, 0, 2), -3)
    on_it = -plane.offset * plane.normal
    assert plane.normal @ on_it + plane.offset == 0
    assert plane.signed_distance([on_it + plane.normal])[0] == pytest.approx(1)


def test_the_accessor_says_what_it_is(shape):
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.PolyData(shape.points)
    assert str(mesh.symmetry) == "Symmetry of PolyData (300 points): detect() finds its mirror"
    mesh.symmetry.detect("plane")
    assert "mirror: plane" in str(mesh.symmetry) and "score: 1.000" in str(mesh.symmetry)
    assert "axis" in inspect.signature(mesh.symmetry.align).parameters
    assert "shape" not in inspect.signature(mesh.symmetry.align).parameters
    assert "symsurf.align" in mesh.symmetry.align.__doc__
