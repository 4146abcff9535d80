"""What holds of every method, operation and analysis, whatever the cloud and the parameters.

The draws follow the descriptions: parameters within their ranges, clouds of few points, with copies,
flat, on lines and lattices, in any unit, and meshes. A draw that is refused is drawn again: what is asked of
results is asked of as many as there are examples.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, reject, settings
from hypothesis import strategies as st
from seeds import draws
from symmetric_shapes import diagonal, random_rotation

import symsurf
from symsurf.mirror_operations.operate import operate
from symsurf.reading.json_records import MIDPOINT_METHODS

METHODS, OPERATIONS, ANALYSES = symsurf.methods(), symsurf.operations(), symsurf.analyses()
# Of each method in the full run, by how long it takes.
EXAMPLES = {"auto": 8, "sphere": 16, "cylinder": 16, "sphere_thesis": 40}
# The same bits for points in any order.
IN_ANY_ORDER = ["separation", "separation_normals", "normals_only", "sphere_thesis"]
THESE = {"deadline": None, "derandomize": True, "suppress_health_check": list(HealthCheck)}


def holds(test, examples):
    """Calls test(data) until so many draws were not rejected."""
    results = 0

    @settings(**THESE, max_examples=examples)
    @given(st.data())
    def counted(data):
        nonlocal results
        test(data)
        results += 1

    counted()
    assert results >= examples


def result_of(call, *given, **parameters):
    """Rejects a draw that is refused."""
    try:
        with np.errstate(all="raise"):
            return call(*given, **parameters)
    except (symsurf.InvalidInput, symsurf.InvalidParameter):
        reject()


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
def clouds(draw, most):
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
    if result.method not in MIDPOINT_METHODS:  # theirs are distances from a line
        images = result.mirror.reflect(points[first])
        distances = np.linalg.norm(images - points[second], axis=1)
        np.testing.assert_allclose(distances, result.residuals, rtol=1e-6, atol=rounding)
    vertices, faces = result.mirror.mesh()
    assert np.isfinite(vertices).all() and (faces < len(vertices)).all()


@pytest.mark.filterwarnings("ignore::symsurf.InputWarning")
@pytest.mark.parametrize("method", METHODS)
def test_every_result_is_sound(method):
    def of_any_cloud(data):
        points = data.draw(clouds(40))
        parameters = data.draw(parameters_of(METHODS[method].parameters))
        result = result_of(symsurf.detect, points, method, threads=1, **parameters)
        expect_sound(result, points)
        if method not in IN_ANY_ORDER:
            return
        order = data.draw(st.permutations(range(len(points))))
        other = symsurf.detect(points[order], method, **parameters)
        assert other.score == result.score and len(other.pairs) == len(result.pairs)
        for one, two in (result, other), (other, result):
            rows = {tuple(row) for row in two.surface_points}
            assert all(tuple(row) in rows for row in one.surface_points)

    holds(of_any_cloud, draws(EXAMPLES.get(method, 80)))


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
        if operation.adds_points:  # without faces that name a corner twice
            faces = faces[[len(set(face)) == 3 for face in faces.tolist()]]
        np.testing.assert_array_equal(shape.faces[: len(faces)], faces)
    if shape.faces is not None and len(shape.faces):
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
def shapes(draw):
    """Points, and no faces, any faces between them, or those of a sheet of their rows and columns."""
    kind = draw(st.sampled_from(["cloud", "any faces", "sheet"]))
    points = draw(clouds(60))
    assume(len(points) > 0 and diagonal(points) > 0)
    if kind == "cloud":
        return points, None
    if kind == "any faces":
        corners = st.integers(0, len(points) - 1)
        return points, np.array(draw(st.lists(st.tuples(*3 * [corners]), min_size=1, max_size=30)))
    rows, columns = draw(st.integers(2, 8)), draw(st.integers(2, 8))
    heights = points[:, 2]
    x, y = (each.ravel() for each in np.indices((rows, columns)) - [[[rows / 2]], [[columns / 2]]])
    sheet = np.column_stack([x, y, np.resize(heights / np.abs(points).max(), rows * columns)])
    corners = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1, 1)
    faces = np.vstack([corners + (0, columns, columns + 1), corners + (0, columns + 1, 1)])
    return sheet * diagonal(points), faces


@pytest.mark.parametrize("name", OPERATIONS)
def test_every_operation_keeps_its_promises(name):
    def on_any_shape(data):
        points, faces = data.draw(shapes())
        mirror = data.draw(mirrors(points))
        parameters = data.draw(parameters_of(OPERATIONS[name].parameters))
        made = result_of(operate, name, points, mirror, faces=faces, **parameters)
        expect_as_described(made, OPERATIONS[name], points, faces)
        expect_consistent(made, points, mirror)

    holds(on_any_shape, draws(160))


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
    def of_any_shape(data):
        points, faces = data.draw(shapes())
        parameters = data.draw(parameters_of(ANALYSES[name].parameters))
        shape = symsurf.Shape(np.asarray(points, float), faces)
        analyse = partial(getattr(symsurf, name), *[shape] * (1 + ANALYSES[name].takes_other))
        found = result_of(analyse, threads=1, **parameters)
        expect_sound_analysis(found, ANALYSES[name], points)
        again = analyse(threads=2, **parameters)
        assert again.to_json() | {"seconds": 0} == found.to_json() | {"seconds": 0}
        for array, values in found.arrays.items():
            np.testing.assert_array_equal(values, again.arrays[array])

    holds(of_any_shape, draws(40))
