"""What holds of every method, operation and analysis, whatever the cloud and the parameters.

The draws follow the descriptions: parameters within their ranges, clouds of few points, with copies,
flat, on lines and lattices, in any unit.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from symmetric_shapes import diagonal, random_rotation

import symsurf
from symsurf.mirror_operations.operate import operate

METHODS, OPERATIONS, ANALYSES = symsurf.methods(), symsurf.operations(), symsurf.analyses()
# Of each method, by how long it takes: the whole in half a minute.
EXAMPLES = {"auto": 8, "sphere": 15, "cylinder": 15, "sphere_thesis": 30}
# The same bits for points in any order.
IN_ANY_ORDER = ["separation", "separation_normals", "normals_only", "sphere_thesis"]
THESE = {"deadline": None, "derandomize": True, "suppress_health_check": list(HealthCheck)}


def scattered(rng, count):
    return rng.normal(size=(count, 3)) * (3, 2, 1)


def mirrored(rng, count):
    half = scattered(rng, (count + 1) // 2)
    return np.vstack([half, half * (-1, 1, 1)])


def mirrored_about_a_sphere(rng, count):
    half = rng.normal(size=((count + 1) // 2, 3)) * 0.2 + (3, 0, 0)
    return np.vstack([half, symsurf.Sphere((0, 0, 0), 3.1).reflect(half)])


def flat(rng, count):
    return scattered(rng, count) * (1, 1, 0)


def on_a_line(rng, count):
    return scattered(rng, count) * (1, 0, 0)


def nearly_on_a_line(rng, count):
    return scattered(rng, count) * (1, 1e-6, 1e-9)


def lattice(rng, count):
    return rng.integers(0, 3, size=(count, 3)).astype(float)


def one_far_away(rng, count):
    points = scattered(rng, count)
    points[:1] *= 1e6
    return points


@st.composite
def clouds(draw, most=40):
    make = draw(
        st.sampled_from(
            [scattered, mirrored, mirrored_about_a_sphere, flat, on_a_line, nearly_on_a_line]
            + [lattice, one_far_away]
        )
    )
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    points = make(rng, draw(st.integers(0, most)))
    points = np.tile(points, (draw(st.sampled_from([1, 1, 1, 2, 5])), 1))
    if draw(st.booleans()):
        points = points @ random_rotation(rng).T
    if draw(st.integers(0, 3)) == 3:
        points = points + 10.0 ** draw(st.integers(0, 15))
    return points * 10.0 ** draw(st.sampled_from([0, 0, 0, -6, 6, -48, 48]))


def value_of(parameter):
    """Near the least, or the default: the greatest may take hours."""
    kind = parameter.type
    if kind == "boolean":
        return st.booleans()
    if kind == "choice":
        return st.sampled_from(parameter.choices)
    if kind == "integer":
        least = int(parameter.minimum)
        return st.integers(least, min(least + 20, int(parameter.maximum)))
    if kind == "real":
        return st.floats(parameter.minimum, min(parameter.maximum, parameter.minimum + 10))
    return st.tuples(*3 * [st.floats(-10, 10)])


def parameters_of(described):
    return st.fixed_dictionaries({}, optional={each.name: value_of(each) for each in described})


def expect_sound(result, points):
    assert 0 <= result.score <= 1
    assert result.verdict in ("found", "none") and result.reason
    count = len(result.pairs)
    assert result.pairs.shape == (count, 2) and result.residuals.shape == (count,)
    assert result.surface_points.shape == (count, 3)
    assert np.isfinite(result.residuals).all() and (result.residuals >= 0).all()
    assert np.isfinite(result.surface_points).all()
    assert ((result.pairs >= 0) & (result.pairs < len(points))).all()
    first, second = result.pairs.T
    assert (np.diff(first) > 0).all()
    assert all(0 <= each.score <= result.score for each in result.candidates)
    if result.mirror is None:
        return
    # Coordinates are rounded where they lie far from 0.
    rounding = 1e-9 * (diagonal(points) + np.abs(points).max())
    images = result.mirror.reflect(points[first])
    distances = np.linalg.norm(images - points[second], axis=1)
    np.testing.assert_allclose(distances, result.residuals, rtol=1e-6, atol=rounding)
    vertices, faces = result.mirror.mesh()
    assert np.isfinite(vertices).all() and (faces < len(vertices)).all()


def found_or_refused(points, method, parameters):
    """None where that is refused, for the points' sake: the parameters are in their ranges."""
    try:
        with np.errstate(all="raise"):
            return symsurf.detect(points, method, threads=1, **parameters)
    except symsurf.InvalidInput as error:
        assert str(error)
    except symsurf.InvalidParameter as error:
        assert "max_radius_divisor" in str(error)  # a range that depends on the other one
    return None


@pytest.mark.filterwarnings("ignore::symsurf.InputWarning")
@pytest.mark.parametrize("method", METHODS)
def test_every_result_is_sound(method):
    @settings(**THESE, max_examples=EXAMPLES.get(method, 60))
    @given(clouds(), parameters_of(METHODS[method].parameters), st.randoms(use_true_random=False))
    def of_any_cloud(points, parameters, random):
        result = found_or_refused(points, method, parameters)
        if result is None:
            return
        expect_sound(result, points)
        if method not in IN_ANY_ORDER:
            return
        order = list(range(len(points)))
        random.shuffle(order)
        other = symsurf.detect(points[order], method, **parameters)
        assert other.score == result.score and len(other.pairs) == len(result.pairs)
        for one, two in (result, other), (other, result):
            rows = {tuple(row) for row in two.surface_points}
            assert all(tuple(row) in rows for row in one.surface_points)

    of_any_cloud()


@st.composite
def mirrors(draw, points):
    """Through the cloud, bent or not."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    centre, size = points.mean(axis=0), diagonal(points)
    through = centre + 0.2 * size * rng.normal(size=3)
    normal, other = random_rotation(rng)[:2]
    radius = size * draw(st.floats(0.3, 10))
    kind = draw(st.sampled_from(["plane", "sphere", "cylinder"]))
    if kind == "plane":
        return symsurf.Plane(normal, -normal @ through)
    if kind == "sphere":
        return symsurf.Sphere(through - radius * normal, radius)
    return symsurf.Cylinder(through - radius * normal, other, radius)


def expect_as_described(made, operation, points, faces):
    described = {array.name: array for array in operation.arrays}
    shape = made.shape
    added = len(shape.points) - len(points)
    if made.is_other:
        assert operation.makes_shape and made.parents.max() < len(points)
    else:
        assert added >= 0 if operation.adds_points else added == 0
    if not operation.moves_points:
        np.testing.assert_array_equal(shape.points[: len(points)], points)
    assert np.isfinite(shape.points).all()
    if faces is not None and not made.is_other:
        np.testing.assert_array_equal(shape.faces[: len(faces)], faces)
    if shape.faces is not None:
        assert shape.faces.min() >= 0 and shape.faces.max() < len(shape.points)
    for name, values in made.arrays.items():
        assert name in described and len(values) == len(shape.points)
    for name, value in made.statistics.items():
        if name.endswith("_share"):
            assert 0 <= value <= 1


def expect_consistent(made, points, mirror):
    """What an operation says of single points, against the mirror and the points themselves."""
    rounding = 1e-9 * (diagonal(points) + np.abs(points).max())
    if made.operation == "correspondences":
        assert ((made.index >= -1) & (made.index < len(points))).all()
        assert ((made.confidence >= 0) & (made.confidence <= 1)).all()
        if made.parameters["one_to_one"]:
            paired = np.flatnonzero(made.index >= 0)
            np.testing.assert_array_equal(made.index[made.index[paired]], paired)
    if made.operation == "asymmetry":
        assert np.isfinite(made.vector[made.matched]).all()
        lengths = np.linalg.norm(made.vector, axis=1)
        np.testing.assert_allclose(made.distance, lengths, rtol=1e-9, atol=rounding)
        limit = made.parameters["max_distance"] * diagonal(points)
        assert (made.distance[made.matched] <= limit + rounding).all()
    if made.operation == "align":
        moved = points @ made.matrix[:3, :3].T + made.matrix[:3, 3]
        np.testing.assert_allclose(made.shape.points, moved, atol=rounding)
        np.testing.assert_allclose(
            made.matrix[:3, :3] @ made.matrix[:3, :3].T, np.eye(3), atol=1e-9
        )
    if made.operation == "symmetrize" and not made.is_other:
        np.testing.assert_array_equal(made.shape.points[~made.paired], points[~made.paired])
    if made.operation == "complete":
        kept = made.origin == 0
        np.testing.assert_array_equal(np.flatnonzero(kept), np.arange(len(points)))
        if made.parameters["blend"] == 0:
            of_sources = mirror.reflect(points[made.sources[made.origin == 1]])
            np.testing.assert_allclose(
                made.shape.points[made.origin == 1], of_sources, atol=rounding
            )


@st.composite
def triangles(draw, points):
    corners = st.integers(0, len(points) - 1)
    return np.array(draw(st.lists(st.tuples(corners, corners, corners), min_size=1, max_size=30)))


@pytest.mark.parametrize("name", OPERATIONS)
def test_every_operation_keeps_its_promises(name):
    @settings(**THESE, max_examples=80)
    @given(st.data())
    def on_any_cloud(data):
        points = data.draw(clouds(60))
        assume(len(points) > 0 and diagonal(points) > 0)
        mirror = data.draw(mirrors(points))
        faces = data.draw(st.none() | triangles(points))
        parameters = data.draw(parameters_of(OPERATIONS[name].parameters))
        try:
            made = operate(name, points, mirror, faces=faces, **parameters)
        except (symsurf.InvalidInput, symsurf.InvalidParameter) as error:
            assert str(error)
            return
        expect_as_described(made, OPERATIONS[name], points, faces)
        expect_consistent(made, points, mirror)

    on_any_cloud()


def expect_sound_analysis(found, analysis, points):
    count = len(points)
    described = {array.name: array for array in analysis.arrays}
    for name, values in found.arrays.items():
        assert len(values) == count
        if described[name].names_points:
            assert ((values >= -1) & (values < count)).all()
    for plane in found.planes:
        assert np.linalg.norm(plane.normal) == pytest.approx(1)
    for axis in found.axes:
        assert np.linalg.norm(axis.direction) == pytest.approx(1)
        assert np.isfinite(axis.point).all() and axis.order >= 0
    for each in found.transformations:
        assert each.matrix.shape == (4, 4) and np.isfinite(each.matrix).all()
        assert 0 <= each.score <= 1
        assert (len(each.from_points) == 0) == (len(each.onto_points) == 0)
        for patch in (each.from_points, each.onto_points):
            assert (np.diff(patch) > 0).all()
            assert len(patch) == 0 or (patch[0] >= 0 and patch[-1] < count)


@pytest.mark.filterwarnings("ignore::symsurf.InputWarning")
@pytest.mark.parametrize("name", ANALYSES)
def test_every_analysis_is_sound(name):
    @settings(**THESE, max_examples=25)
    @given(st.data())
    def of_any_shape(data):
        points = data.draw(clouds(60))
        faces = data.draw(st.none() | triangles(points)) if len(points) else None
        parameters = data.draw(parameters_of(ANALYSES[name].parameters))
        analyse = getattr(symsurf, name)
        try:
            found = analyse(points, faces=faces, threads=1, **parameters)
        except (symsurf.InvalidInput, symsurf.InvalidParameter) as error:
            assert str(error)
            return
        expect_sound_analysis(found, ANALYSES[name], points)
        again = analyse(points, faces=faces, threads=2, **parameters)
        assert again.to_json() | {"seconds": 0} == found.to_json() | {"seconds": 0}
        for array, values in found.arrays.items():
            np.testing.assert_array_equal(values, again.arrays[array])

    of_any_shape()
