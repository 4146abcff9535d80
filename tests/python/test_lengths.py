"""Lengths in input units, and the units in errors."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from symmetric_shapes import diagonal, mirrored_surface

import symsurf
from symsurf.mirror_operations.operate import operate

LENGTHS = [
    (f"detect_{name}", parameter.name)
    for name, method in symsurf.methods().items()
    for parameter in method.parameters
    if parameter.unit == "diagonal"
] + [
    (name, parameter.name)
    for name, operation in symsurf.operations().items()
    for parameter in operation.parameters
    if parameter.unit == "diagonal"
]


@pytest.fixture(scope="module")
def points():
    return mirrored_surface(100, 0)[0]


@pytest.mark.parametrize(("function", "parameter"), LENGTHS)
def test_every_length_may_be_in_input_units(function, parameter, points):
    is_operation = function in symsurf.operations()
    call = partial(operate, function) if is_operation else getattr(symsurf, function)
    shape = 25.4 * points
    if is_operation and symsurf.operations()[function].needs_faces:
        shape = symsurf.Shape(shape, [[i, i + 1, i + 2] for i in range(0, 9, 3)])
    length = 0.0625 * diagonal(25.4 * points)
    made = call(shape, absolute=True, **{parameter: length})
    if made.parameters.keys() >= {parameter}:  # "auto" names those of the method it chose
        assert made.parameters[parameter] == pytest.approx(0.0625, rel=1e-12)
    with pytest.raises(symsurf.InvalidParameter, match=rf"{parameter} is .*of the diagonal"):
        call(shape, **{parameter: length})
    too_long = 1.5 * diagonal(25.4 * points)
    with pytest.raises(symsurf.InvalidParameter, match=f"{parameter} is .* input units; allowed"):
        call(shape, absolute=True, **{parameter: too_long})


@settings(deadline=None, max_examples=25)
@given(st.floats(1e-3, 1e3), st.floats(0.001, 0.2))
def test_partners_are_nearer_than_the_length(scale, share):
    points, mirror = mirrored_surface(300, 1)
    points = scale * (points + np.random.default_rng(0).normal(size=points.shape) * 0.03)
    mirror = symsurf.Plane(mirror.normal, scale * mirror.offset)
    length = share * diagonal(points)
    result = symsurf.match(points, mirror, length, absolute=True)
    distances = np.linalg.norm(mirror.reflect(points)[:, None] - points, axis=2).min(axis=1)
    assert len(result.pairs) == np.count_nonzero(distances <= length)


def test_outliers_do_not_change_the_length():
    """They do not count for the diagonal."""
    points, mirror = mirrored_surface(800, 0)
    noisy = points + np.random.default_rng(0).normal(size=points.shape) * 0.02
    outliers = 300 * np.random.default_rng(0).normal(size=(5, 3))
    pairs = [
        found.pairs
        for given in (noisy, np.vstack([noisy, outliers]))
        for found in (symsurf.match(given, mirror, 0.03, absolute=True),)
    ]
    np.testing.assert_array_equal(*pairs)
    result = symsurf.detect_plane(np.vstack([noisy, outliers]), pair_distance=0.03, absolute=True)
    assert result.statistics["outliers"] == 5
    assert result.parameters["pair_distance"] == pytest.approx(0.03 / diagonal(noisy))
    assert result.residuals.max() <= 0.03 and len(result.pairs) > 100


def test_what_is_no_length_is_as_ever(points):
    one = symsurf.detect_plane(points, sample_size=500, minimum_score=0.4, absolute=True)
    other = symsurf.detect_plane(points, sample_size=500, minimum_score=0.4)
    assert one.parameters == other.parameters and one.mirror == other.mirror
    for value in ("2 mm", True, None, (1, 2)):
        with pytest.raises(symsurf.InvalidParameter, match=r"pair_distance is .*of the diagonal"):
            symsurf.detect_plane(points, pair_distance=value, absolute=True)
    with pytest.raises(symsurf.InvalidParameter, match="no method 'plain'"):
        symsurf.detect(points, "plain", pair_distance=2, absolute=True)
    with pytest.raises(symsurf.InvalidParameter, match="'plane' has no parameter 'distance'"):
        symsurf.detect_plane(points, distance=2, absolute=True)


def test_errors_name_units(points):
    for function, parameter, says in [
        ("asymmetry", "max_angle", r"allowed is real \[0, 90\] degrees"),
        ("asymmetry", "max_distance", r"allowed is real \[0, 1\] of the diagonal"),
        ("detect_plane", "sample_size", r"allowed is integer \[100, 100000\] points"),
    ]:
        for wrong in (-1, "many"):
            with pytest.raises(symsurf.InvalidParameter, match=says):
                getattr(symsurf, function)(points, **{parameter: wrong})
