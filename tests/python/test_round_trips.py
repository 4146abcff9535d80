"""What goes through pickle, copy and JSON comes back to the same bits."""

from __future__ import annotations

import copy
import dataclasses
import json
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from symmetric_shapes import mirrored_surface

import symsurf
from symsurf import synthetic
from symsurf.benchmark.answers import answer_in
from symsurf.benchmark.files import read_benchmark
from symsurf.mirror_operations.operate import operate
from symsurf.reading.json_records import mirror_from
from symsurf.results.base_result import mirror_record
from symsurf.saving.truth import read_truth

numbers = st.floats(-1e6, 1e6, allow_subnormal=False)
lengths = st.floats(1e-3, 1e6)
vectors = st.tuples(numbers, numbers, numbers)
directions = vectors.filter(lambda v: np.linalg.norm(v) > 1e-3)
tables = st.lists(vectors, min_size=4, max_size=9).map(np.array)


@st.composite
def free_forms(draw):
    count = draw(st.integers(1, 4))
    patches = range(count)
    frames = [np.linalg.qr(np.array(draw(vectors)) + np.diag((3, 5, 7)))[0] for _ in patches]
    numbers_ = {
        "centres": np.array([draw(vectors) for _ in patches]),
        "tangents": np.array([frame[:, 0] for frame in frames]),
        "normals": np.array([frame[:, 2] for frame in frames]),
        "heights": np.array([draw(vectors) + draw(vectors) for _ in patches]),
        "radii": np.array([[draw(lengths)] for _ in patches]),
    }
    return symsurf.make_mirror("free-form", numbers_)


mirrors = st.one_of(
    st.builds(symsurf.Plane, directions, numbers),
    st.builds(symsurf.Sphere, vectors, lengths),
    st.builds(symsurf.Cylinder, vectors, directions, lengths),
    st.builds(symsurf.Quadric, tables.map(lambda t: t[:3]), directions, numbers),
    st.builds(symsurf.HeightField, directions, tables),
    free_forms(),
)
TRIPS = {
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}


@settings(deadline=None)
@given(mirrors, st.sampled_from(sorted(TRIPS)))
def test_mirrors_come_back(mirror, trip):
    twin = TRIPS[trip](mirror)
    assert twin is not mirror and type(twin) is type(mirror)
    assert twin == mirror and hash(twin) == hash(mirror)
    points = np.random.default_rng(0).normal(size=(20, 3))
    np.testing.assert_array_equal(twin.reflect(points), mirror.reflect(points))


@settings(deadline=None)
@given(mirrors)
def test_mirrors_come_back_from_json(mirror):
    twin = mirror_from(json.loads(json.dumps(mirror_record(mirror))))
    assert twin == mirror


@given(directions, numbers)
def test_a_bit_makes_another_mirror(normal, offset):
    plane = symsurf.Plane(normal, offset)
    other = symsurf.Plane(plane.normal, np.nextafter(plane.offset, np.inf))
    assert plane != other
    assert (plane == other) is False
    assert plane != symsurf.Sphere((0, 0, 0), 1) and plane != "plane"
    assert symsurf.Plane(plane.normal, plane.offset) in {plane, other}


def test_zeros_of_both_signs_are_one():
    planes = symsurf.Plane((1, 0, 0), 0.0), symsurf.Plane((1, -0.0, 0), -0.0)
    assert planes[0] == planes[1] and len(set(planes)) == 1


def fields_of(thing):
    return {each.name: getattr(thing, each.name) for each in dataclasses.fields(thing)}


def assert_same(one, other):
    """To the last bit, whatever it is."""
    assert type(one) is type(other)
    if dataclasses.is_dataclass(one):
        one, other = fields_of(one), fields_of(other)
    if isinstance(one, dict):
        assert one.keys() == other.keys()
        for name, value in one.items():
            assert_same(value, other[name])
    elif isinstance(one, list):
        assert len(one) == len(other)
        for pair in zip(one, other, strict=True):
            assert_same(*pair)
    elif isinstance(one, np.ndarray):
        assert one.dtype == other.dtype
        np.testing.assert_array_equal(one, other)
    elif isinstance(one, symsurf.Mirror):
        assert one == other
        assert_same(one.footprint, other.footprint)
    else:
        np.testing.assert_equal(one, other)


def results():
    points, _ = mirrored_surface(700, 0)
    bent = symsurf.bend(points, symsurf.Cylinder((-4, 0, 0), (0, 1, 0), 4), back=True)
    layers = synthetic.mirror_fixed(
        np.random.default_rng(0).uniform(-1, 1, size=(300, 3)) + (0, 0, 3), "f1"
    ).points
    for name in symsurf.methods():
        others = {"cylinder": bent, "fixed_direction": layers, "sphere_thesis": points[:100]}
        yield name, others.get(name, points)


@pytest.mark.parametrize(("method", "points"), list(results()), ids=symsurf.methods())
def test_results_come_back(method, points, tmp_path):
    result = symsurf.detect(points, method)
    for trip in (TRIPS["pickle"], TRIPS["deepcopy"]):
        assert_same(trip(result), result)
    result.save(tmp_path / "result.json")
    loaded = symsurf.Result.load(tmp_path / "result.json")
    assert loaded.points is None and loaded.faces is None
    # Of a candidate a file says what it is, and how good.
    shorter = [
        dataclasses.replace(each, parameters={}, statistics={}, seconds=0.0)
        for each in result.candidates
    ]
    assert_same(loaded, dataclasses.replace(result, points=None, faces=None, candidates=shorter))
    assert loaded.verdict == result.verdict and loaded.reason == result.reason
    if result.mirror is not None:
        assert_same(list(loaded.mirror.mesh()), list(result.mirror.mesh()))


@pytest.mark.parametrize("method", ["plane", "fixed_direction", "perpendicular", "quadric"])
def test_results_of_older_versions_are_loaded(method, blob, tmp_path):
    """They have no footprint, no axes, and statistics under their old names."""
    points = np.vstack([blob, blob * (-1, 1, 1)])
    result = symsurf.detect(points, method)
    path = tmp_path / "result.json"
    result.save(path)
    record = json.loads(path.read_text())
    for name in ("footprint", "space"):
        del record[name]
    record["statistics"] |= {"stray_points": 3, "skin_points": 5}
    path.write_text(json.dumps(record))
    loaded = symsurf.Result.load(path)
    assert loaded.mirror.kind == result.mirror.kind and loaded.score == result.score
    assert_same(loaded.surface_points, result.surface_points)
    assert loaded.statistics["outliers"] == 3 and loaded.statistics["boundary_points"] == 5
    assert loaded.verdict == result.verdict
    made = symsurf.asymmetry(points, loaded)
    assert np.isfinite(made.statistics["rms"])


def test_what_is_not_a_number_is_none_after_loading(tmp_path):
    points, mirror = mirrored_surface(200, 0)
    result = symsurf.match(points, mirror)
    result = dataclasses.replace(result, statistics={"mean": float("nan"), "normal": np.ones(3)})
    result.save(tmp_path / "result.json")
    assert_same(symsurf.Result.load(tmp_path / "result.json").statistics, result.statistics)


@pytest.mark.parametrize(
    ("name", "content", "error", "says"),
    [
        ("gone.json", None, symsurf.InvalidInput, "gone.json: No such file"),
        ("broken.json", "{", symsurf.InvalidInput, "broken.json: no JSON"),
        ("list.json", "[]", symsurf.InvalidInput, "list.json: no result"),
        ("other.json", '{"method": "plane"}', symsurf.InvalidInput, "other.json: no result"),
        ("result.ply", "", symsurf.InvalidParameter, "allowed is the suffix .json"),
    ],
)
def test_what_cannot_be_loaded_is_named(name, content, error, says, tmp_path):
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(error, match=says):
        symsurf.Result.load(tmp_path / name)


PLANE = '{"kind": "plane", "normal": [1, 0, 0], "offset": 0}'
HUGE = "1" + 400 * "0"  # no double holds it
BROKEN = {
    "deep": 100_000 * "[",
    "deep objects": 100_000 * '{"a":',
    "infinite": f'{{"mirror": {PLANE}, "pairs": [[1e400, 0]]}}',
    "fractions": f'{{"mirror": {PLANE}, "pairs": [[0.5, 1]]}}',
    "words": f'{{"mirror": {PLANE}, "pairs": [["0", "1"]]}}',
    "too large": f'{{"mirror": {PLANE}, "pairs": [[{10**30}, 0]]}}',
    "huge": f'{{"mirror": {PLANE}, "pairs": [[{HUGE}, 0]]}}',
    "a huge vector": f'{{"mirror": {PLANE.replace("1", HUGE)}, "pairs": []}}',
    "a huge number": f'{{"mirror": {PLANE.replace(": 0", ": " + HUGE)}, "pairs": []}}',
    "a kind": f'{{"mirror": {PLANE.replace("plane", "x")}, "pairs": []}}',
    "a list": "[]",
    "a number": "5",
    "no text": "\udcff",
}


@pytest.mark.parametrize("content", BROKEN)
def test_broken_json_is_named(content, tmp_path):
    whole = {"method": "plane", "score": 0, "candidates": [], "footprint": None}
    for name, read in {
        "result.json": symsurf.Result.load,
        "cloud.truth.json": read_truth,
        "case.json": lambda path: answer_in(tmp_path, "case", np.eye(3)),
        "truth.json": lambda path: read_benchmark(tmp_path),
    }.items():
        path = tmp_path / name
        text = BROKEN[content]
        if name == "result.json":
            text = text.replace("{", json.dumps(whole)[:-1] + ", ", 1)
        if name == "case.json" and '"pairs": [[' in text:
            continue  # it holds none
        path.write_text(text, errors="surrogateescape")
        with pytest.raises(symsurf.InvalidInput) as error:
            read(path)
        assert str(error.value).startswith(f"{path}: no") and "\n" not in str(error.value)


def test_the_method_of_a_result_is_a_word(tmp_path):
    points, mirror = mirrored_surface(200, 0)
    path = tmp_path / "result.json"
    symsurf.match(points, mirror).save(path)
    path.write_text(json.dumps(json.loads(path.read_text()) | {"method": 3}))
    with pytest.raises(symsurf.InvalidInput, match="method is 3; allowed is a word"):
        symsurf.Result.load(path)


@pytest.mark.parametrize("field", ["score", "seconds"])
@pytest.mark.parametrize("value", ["abc", "0.5", True, [1], {"a": 1}])
def test_figures_of_a_result_are_numbers(field, value, tmp_path):
    points, mirror = mirrored_surface(200, 0)
    path = tmp_path / "result.json"
    symsurf.match(points, mirror).save(path)
    path.write_text(json.dumps(json.loads(path.read_text()) | {field: value}))
    with pytest.raises(
        symsurf.InvalidInput, match=rf"result.json: .*{field} is .*; allowed is a n"
    ):
        symsurf.Result.load(path)


def changed(record, path, value):
    """A copy with another value at the path; nothing at it where the value is ``del``."""
    copy_ = json.loads(json.dumps(record))
    inner = copy_
    for step in path[:-1]:
        inner = inner[step]
    if value == "del":
        del inner[path[-1]]
    else:
        inner[path[-1]] = value
    return copy_


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("mirror", "radius"), 1e300),
        (("mirror", "radius"), None),
        (("mirror", "centre", 1), 77.0),
        (("mirror", "centre"), [None] * 3),
        (("candidates", 0, "mirror", "centre"), [1e200, 0, 0]),
        (("residuals",), []),
        (("residuals",), 4.0),
        (("residuals", 3), None),
        (("residuals", 3), -1.0),
        (("surface_points", 2, 0), None),
        (("surface_points", 2), "del"),
        (("pairs", 0, 1), -1),
        (("pairs", 0), "del"),
        (("score",), None),
        (("score",), 1.5),
        (("candidates", 0, "score"), -1),
        (("seconds",), None),
    ],
)
def test_a_result_that_was_damaged_is_no_result(path, value, tmp_path):
    points, mirror = mirrored_surface(200, 0)
    sphere = symsurf.Sphere(1000 * mirror.normal, 1000 - mirror.offset)
    other = symsurf.match(points, symsurf.Sphere(900 * mirror.normal, 900 - mirror.offset))
    result = dataclasses.replace(symsurf.match(points, sphere), candidates=[other])
    file = tmp_path / "result.json"
    result.save(file)
    record = json.loads(file.read_text())
    assert symsurf.Result.load(file).mirror == sphere
    file.write_text(json.dumps(changed(record, path, value)))
    with pytest.raises(symsurf.InvalidInput, match=r"result.json: no result that was saved \("):
        symsurf.Result.load(file)


@pytest.mark.parametrize("name", symsurf.operations())
def test_what_operations_give_comes_back(name):
    points, mirror = mirrored_surface(400, 0)
    faces = [[i, i + 1, i + 2] for i in range(0, 399, 3)]
    made = operate(name, symsurf.Shape(points, faces), mirror)
    for trip in (TRIPS["pickle"], TRIPS["deepcopy"]):
        assert_same(trip(made), made)


@settings(deadline=None)
@given(tables, st.booleans(), st.booleans())
def test_shapes_come_back(points, has_faces, has_normals):
    pytest.importorskip("pyvista")
    faces = np.array([[0, 1, 2], [1, 3, 2]]) if has_faces else None
    normals = np.tile((0.0, 0.6, 0.8), (len(points), 1)) if has_normals else None
    shape = symsurf.Shape(points, faces, normals)
    for trip in TRIPS.values():
        assert_same(trip(shape), shape)
    mesh = shape.to_pyvista()
    assert mesh.n_points == len(points)
    assert_same(symsurf.Shape.from_pyvista(mesh), shape)
    mesh.points[0] = 0  # is its own
    assert_same(symsurf.Shape(points.copy(), faces, normals), shape)
