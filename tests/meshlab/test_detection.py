"""What the filters leave in the document is what symsurf.detect says about the same points."""

from __future__ import annotations

import numpy as np
import pymeshlab
import pytest
from seeds import FULL, SEEDS
from shapes import SHAPES, Shape, cloud, mesh

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")


def changed(p: symsurf.Parameter) -> object:
    """Another value than the default, of few digits, in the parameter's range."""
    if p.type == "boolean":
        return not p.default
    if p.type == "choice":
        return p.choices[p.choices.index(p.default) - 1]
    if p.type == "integer":
        return p.default + 1 if p.default < p.maximum else p.default - 1
    if p.type == "real":
        other = float(f"{0.9 * p.default:.3g}")
        return other if p.minimum <= other != p.default else min(0.1, p.maximum)
    return np.array([0.25, 0.5, 1.0])


def in_meshlab(p: symsurf.Parameter, value: object) -> object:
    if p.type == "real" and p.unit == "diagonal":
        return pymeshlab.PercentageValue(100 * value)
    return value


def all_changed(method: str) -> tuple[dict, dict]:
    """But for the pairs, which are compared."""
    parameters = [p for p in symsurf.methods()[method].parameters if p.name != "pairs"]
    values = {p.name: changed(p) for p in parameters}
    return values, {p.name: in_meshlab(p, values[p.name]) for p in parameters}


def layer(mesh_set: pymeshlab.MeshSet, name: str) -> pymeshlab.Mesh:
    (found,) = [m for m in mesh_set if m.label() == name]
    return found


def assert_same(mesh_set: pymeshlab.MeshSet, returned: dict, expected, shape: Shape, rows=None):
    """The document and the returned values against a result over the points `rows`."""
    rows = np.arange(len(shape.points)) if rows is None else rows
    near = {"rtol": 0, "atol": 1e-12 * shape.diagonal}
    assert returned["score"] == pytest.approx(expected.score, abs=1e-12)
    assert returned["pairs"] == len(expected.pairs)
    assert returned["found"] is (expected.verdict == "found")

    marked = layer(mesh_set, "shape")
    quality = np.full(len(shape.points), -1.0)
    quality[rows[expected.pairs[:, 0]]] = expected.residuals
    partner = np.full(len(shape.points), -1)
    partner[rows[expected.pairs[:, 0]]] = rows[expected.pairs[:, 1]]
    assert np.allclose(marked.vertex_scalar_array(), quality, **near)
    assert np.array_equal(marked.vertex_custom_scalar_attribute_array("partner"), partner)
    assert np.array_equal(marked.vertex_matrix(), shape.points)

    found = layer(mesh_set, "Surface points")
    assert np.allclose(found.vertex_matrix(), expected.surface_points, **near)
    assert np.allclose(found.vertex_scalar_array(), expected.residuals, **near)
    assert mesh_set[returned["surface_points_layer"]].label() == "Surface points"

    side = np.zeros(len(shape.points))
    if expected.mirror is None:
        assert "Mirror" not in [m.label() for m in mesh_set]
    else:
        side[rows] = np.sign(np.nan_to_num(expected.mirror.signed_distance(shape.points[rows])))
        vertices, triangles = expected.mirror.mesh()
        drawn = layer(mesh_set, "Mirror")
        assert np.allclose(drawn.vertex_matrix(), vertices, **near)
        assert np.array_equal(drawn.face_matrix(), triangles)
        for name in set(returned) & {"normal", "offset", "centre", "radius", "matrix"}:
            assert np.allclose(returned[name], getattr(expected.mirror, name), **near), name
    assert np.array_equal(marked.vertex_custom_scalar_attribute_array("side"), side)


@pytest.mark.parametrize("kind", SHAPES)
@pytest.mark.parametrize("method", symsurf.methods())
def test_defaults(method, kind):
    shape = SHAPES[kind](0)
    mesh_set = shape.mesh_set()
    returned = mesh_set.apply_filter("compute_mirror_" + method)
    assert_same(mesh_set, returned, symsurf.detect(shape.points, method, faces=shape.faces), shape)
    assert mesh_set.current_mesh().label() == "shape"


@pytest.mark.parametrize("kind", SHAPES if SEEDS >= FULL else ["cloud"])
@pytest.mark.parametrize("method", symsurf.methods())
def test_changed_parameters(method, kind):
    shape = SHAPES[kind](2)
    here, there = all_changed(method)
    expected = symsurf.detect(shape.points, method, faces=shape.faces, seed=3, threads=1, **here)
    mesh_set = shape.mesh_set()
    returned = mesh_set.apply_filter("compute_mirror_" + method, seed=3, threads=1, **there)
    assert_same(mesh_set, returned, expected, shape)


def test_pairs_can_be_left_out():
    shape = mesh(4)
    mesh_set = shape.mesh_set()
    returned = mesh_set.apply_filter("compute_mirror_plane", pairs=False)
    assert returned["score"] == symsurf.detect(shape.points, "plane", faces=shape.faces).score
    assert returned["pairs"] == 0
    assert "Surface points" not in [m.label() for m in mesh_set]
    partner = layer(mesh_set, "shape").vertex_custom_scalar_attribute_array("partner")
    assert np.all(partner == -1)


@pytest.mark.parametrize("method", ["auto", "plane", "normals_only"])
def test_faces_can_be_left_aside(method):
    shape = mesh(4)
    mesh_set = shape.mesh_set()
    returned = mesh_set.apply_filter("compute_mirror_" + method, use_faces=False)
    assert_same(mesh_set, returned, symsurf.detect(shape.points, method), shape)
    assert "surface_samples" not in returned


@pytest.mark.parametrize("value", [np.nan, -np.inf])
@pytest.mark.parametrize("method", ["auto", "plane", "normals_only"])
def test_vertices_that_are_not_finite_are_left_out(method, value):
    shape = cloud(3)
    shape.points[[3, 17], 1] = value
    mesh_set = shape.mesh_set()
    returned = mesh_set.apply_filter("compute_mirror_" + method)
    assert returned["nonfinite_points"] == 2
    with pytest.warns(symsurf.InputWarning):
        expected = symsurf.detect(shape.points, method)
    assert returned["score"] == pytest.approx(expected.score, abs=1e-12)
    assert returned["pairs"] == len(expected.pairs)
    partner = layer(mesh_set, "shape").vertex_custom_scalar_attribute_array("partner")
    assert partner[3] == partner[17] == -1 and np.isin([3, 17], partner).sum() == 0
    side = layer(mesh_set, "shape").vertex_custom_scalar_attribute_array("side")
    assert side[3] == side[17] == 0


@pytest.mark.parametrize("method", symsurf.methods())
def test_normals_are_handed_on(method):
    shape = mesh(4)
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_normal_per_vertex")
    normals = mesh_set.current_mesh().vertex_normal_matrix()
    returned = mesh_set.apply_filter("compute_mirror_" + method, use_normals=True)
    expected = symsurf.detect(shape.points, method, faces=shape.faces, normals=normals)
    assert_same(mesh_set, returned, expected, shape)


@pytest.mark.parametrize("method", symsurf.methods())
def test_a_selection_restricts_the_search(method):
    shape = cloud(5)
    chosen = shape.points[:, 0] < np.quantile(shape.points[:, 0], 0.8)
    mesh_set = shape.mesh_set()
    x = np.max(shape.points[chosen, 0])
    mesh_set.apply_filter("compute_selection_by_condition_per_vertex", condselect=f"x <= {x:.17g}")
    assert np.array_equal(mesh_set.current_mesh().vertex_selection_array(), chosen)
    returned = mesh_set.apply_filter("compute_mirror_" + method, only_selected=True)
    expected = symsurf.detect(shape.points[chosen], method)
    assert_same(mesh_set, returned, expected, shape, np.flatnonzero(chosen))


def test_selected_faces_select_their_corners():
    shape = mesh(6)
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_selection_by_condition_per_face", condselect="fi < 300")
    chosen = np.unique(shape.faces[:300])
    returned = mesh_set.apply_filter("compute_mirror_plane", only_selected=True)
    row = np.full(len(shape.points), -1)
    row[chosen] = np.arange(len(chosen))
    faces = row[shape.faces]
    faces = faces[(faces >= 0).all(axis=1)]
    expected = symsurf.detect(shape.points[chosen], "plane", faces=faces)
    assert_same(mesh_set, returned, expected, shape, chosen)


def test_the_layer_transform_is_carried_to_the_results():
    shape = cloud(8)
    mesh_set = shape.mesh_set()
    matrix = np.eye(4)
    matrix[:3, 3] = 4, 5, 6
    mesh_set.apply_filter("set_matrix", transformmatrix=matrix, freeze=False)
    returned = mesh_set.apply_filter("compute_mirror_plane")
    expected = symsurf.detect(shape.points, "plane")
    assert_same(mesh_set, returned, expected, shape)
    for name in ("Mirror", "Surface points"):
        assert np.array_equal(layer(mesh_set, name).transform_matrix(), matrix)
