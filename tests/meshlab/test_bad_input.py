"""Every failure is a sentence; the host lives on and the document is as it was."""

from __future__ import annotations

import math
import re

import numpy as np
import pymeshlab
import pytest
from bad_input import tables
from shapes import cloud, lump, lump_cloud, mesh

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")


def filter_of(operation: str) -> str:
    described = symsurf.operations()[operation]
    changes = described.moves_points or described.adds_points or described.carries_values
    return ("apply_" if changes else "compute_") + described.title.lower().replace(" ", "_")


# Every description that a filter is made of, by the name of the filter.
DESCRIBED = {"compute_mirror_" + name: method for name, method in symsurf.methods().items()}
DESCRIBED |= {filter_of(name): operation for name, operation in symsurf.operations().items()}
OPERATIONS = [filter_of(name) for name in symsurf.operations()]
# Whose mirror is to be that of the shape.
OF_OWN_MIRROR = [
    filter_of(name) for name, o in symsurf.operations().items() if not o.takes_any_mirror
]


# An unknown choice pymeshlab itself refuses.
REFUSALS = (pymeshlab.PyMeshLabException, pymeshlab.InvalidEnumException)


def state(mesh_set: pymeshlab.MeshSet) -> list:
    return [
        (
            m.label(),
            m.vertex_matrix().tobytes(),
            m.face_matrix().tobytes(),
            m.vertex_scalar_array().tobytes(),
            m.vertex_color_matrix().tobytes(),
            m.has_vertex_scalar(),
            m.has_vertex_color(),
        )
        for m in mesh_set
    ]


def assert_refused(mesh_set: pymeshlab.MeshSet, filter_name: str, sentence: str, **parameters):
    before = state(mesh_set)
    with pytest.raises(REFUSALS, match=sentence):
        mesh_set.apply_filter(filter_name, **parameters)
    assert state(mesh_set) == before
    if len(mesh_set) > 0:
        for attribute in ("partner", "side", "distance", "index", "paired", "origin"):
            with pytest.raises(pymeshlab.PyMeshLabException):
                mesh_set.current_mesh().vertex_custom_scalar_attribute_array(attribute)
    assert cloud(9).mesh_set().apply_filter("compute_mirror_plane")["pairs"] > 0


def layer(points) -> pymeshlab.MeshSet:
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(vertex_matrix=np.asarray(points, float)), "layer")
    return mesh_set


# A layer without vertices is another case: MeshLab has none to begin with. A filter always leaves
# out points that are not finite.
CLOUDS = [
    pytest.param(cloud, id=cloud.name)
    for cloud in tables.clouds()
    if cloud.points and not cloud.refuses_nonfinite
]


@pytest.mark.parametrize("bad", CLOUDS)
@pytest.mark.parametrize("filter_name", DESCRIBED)
def test_layers_that_cannot_be_used(filter_name, bad):
    assert_refused(layer(bad.points), filter_name, re.escape(bad.reason))


@pytest.mark.parametrize("filter_name", DESCRIBED)
def test_no_layer(filter_name):
    assert_refused(pymeshlab.MeshSet(), filter_name, "requires at least one mesh")


@pytest.mark.parametrize("filter_name", DESCRIBED)
def test_all_vertices_removed(filter_name):
    mesh_set = mesh().mesh_set()
    mesh_set.apply_filter("set_selection_all")
    mesh_set.apply_filter("meshing_remove_selected_vertices")
    assert_refused(mesh_set, filter_name, "'shape' has no vertices")


def numbers_out_of_range():
    for filter_name, described in DESCRIBED.items():
        for p in described.parameters:
            if p.type not in ("integer", "real"):
                continue
            outside = [v for v in (p.minimum - 1, p.maximum + 1) if abs(v) < 2**31]
            for value in outside if p.type == "integer" else [*outside, math.inf, math.nan]:
                yield pytest.param(filter_name, p, value, id=f"{filter_name}-{p.name}-{value}")


@pytest.mark.parametrize(("filter_name", "p", "value"), list(numbers_out_of_range()))
def test_numbers_out_of_range(filter_name, p, value):
    shape = cloud()
    if p.type == "integer":
        value = int(value)
    elif p.unit == "diagonal":
        value = pymeshlab.PureValue(value * shape.diagonal)
    sentence = f"{p.name} is .*; allowed is {p.type} "
    assert_refused(shape.mesh_set(), filter_name, sentence, **{p.name: value})


def choices():
    for filter_name, described in DESCRIBED.items():
        yield from ((filter_name, p.name) for p in described.parameters if p.type == "choice")


@pytest.mark.parametrize(("filter_name", "name"), list(choices()))
def test_unknown_choice(filter_name, name):
    assert_refused(cloud().mesh_set(), filter_name, "not-there", **{name: "not-there"})


@pytest.mark.parametrize("filter_name", DESCRIBED)
def test_common_parameters(filter_name):
    sentence = "threads is -1; allowed is integer"
    assert_refused(cloud().mesh_set(), filter_name, sentence, threads=-1)


@pytest.mark.parametrize("method", symsurf.methods())
def test_common_parameters_of_methods(method):
    filter_name = "compute_mirror_" + method
    assert_refused(cloud().mesh_set(), filter_name, "seed is -1; allowed is integer", seed=-1)
    assert_refused(cloud().mesh_set(), filter_name, "nothing selected", only_selected=True)
    assert_refused(cloud().mesh_set(), filter_name, "are all zero", use_normals=True)


@pytest.mark.parametrize("filter_name", OPERATIONS)
def test_layers_that_hold_no_mirror(filter_name):
    mesh_set = mesh().mesh_set()
    mesh_set.add_mesh(pymeshlab.Mesh(lump_cloud().points), "other")
    mesh_set.set_current_mesh(0)
    assert_refused(mesh_set, filter_name, "'other' holds no mirror", mirror_layer=1)
    assert_refused(mesh().mesh_set(), filter_name, "no layer 7", mirror_layer=7)


def with_tiny_sphere(away):
    """A shape, and so many diagonals from it along each axis a sphere of another scale."""
    shape = mesh()
    sphere = np.random.default_rng(0).normal(size=(50, 3))
    sphere *= (0.01 / np.linalg.norm(sphere, axis=1))[:, None]
    mesh_set = shape.mesh_set()
    mesh_set.add_mesh(pymeshlab.Mesh(sphere + shape.points[0] + away * shape.diagonal), "tiny")
    mesh_set.set_current_mesh(0)
    return mesh_set


@pytest.mark.parametrize("filter_name", OF_OWN_MIRROR)
def test_a_mirror_far_away(filter_name):
    assert_refused(with_tiny_sphere(9), filter_name, "diagonals away from this", mirror_layer=1)


# Those that ask for the images of points; the others need their feet alone.
@pytest.mark.parametrize(
    "filter_name",
    [f for f in OF_OWN_MIRROR if "alignment" not in f and "straightening" not in f],
)
def test_a_mirror_of_another_scale(filter_name):
    if filter_name == "apply_mirror_cut":
        pytest.skip("cuts along any mirror")
    is_remeshed = filter_name == "apply_mirror_remeshing"
    reason = (
        "points of the side have no image" if is_remeshed else "only 0 of 240 points have an image"
    )
    assert_refused(with_tiny_sphere(2), filter_name, reason, mirror_layer=1)


@pytest.mark.parametrize("filter_name", OPERATIONS)
def test_a_mirror_that_is_shown_distorted(filter_name):
    mesh_set = lump().mesh_set()
    other = mesh_set.apply_filter("compute_mirror_plane")["mirror_layer"]
    mesh_set.set_current_mesh(other)
    sheared = np.eye(4)
    sheared[0, 1] = 0.5
    mesh_set.apply_filter("set_matrix", transformmatrix=sheared, freeze=False)
    mesh_set.set_current_mesh(0)
    parameters = {"mirror_layer": other}
    before = state(mesh_set)
    with pytest.raises(pymeshlab.PyMeshLabException, match="a turn, a shift and a scaling"):
        mesh_set.apply_filter(filter_name, **parameters)
    assert state(mesh_set) == before


@pytest.mark.parametrize("filter_name", OPERATIONS)
def test_vertices_that_are_not_finite(filter_name):
    """They are left out, and stay in a layer that keeps its vertices."""
    shape = lump() if "remeshing" in filter_name else lump_cloud()
    shape.points[5, 1] = np.nan
    mesh_set = shape.mesh_set()
    assert mesh_set.apply_filter(filter_name)["nonfinite_points"] == 1
    is_other = filter_name in ("apply_mirror_remeshing", "apply_mirror_cut")
    broken = np.flatnonzero(np.isnan(mesh_set.mesh(0).vertex_matrix()).any(axis=1))
    assert broken.tolist() == ([] if is_other else [5])


@pytest.mark.parametrize("filter_name", OPERATIONS)
def test_a_layer_without_symmetry(filter_name):
    lengths = np.random.default_rng(0).random((60, 3)) ** 4
    mesh_set = layer(lengths)
    if filter_name == "apply_mirror_remeshing":
        assert_refused(mesh_set, filter_name, "no faces given for 60 points; remesh needs a mesh")
        return
    assert_refused(mesh_set, filter_name, "the shape has no mirror: .*scores", require_found=True)
    assert mesh_set.apply_filter(filter_name)["mirror_layer"] == 1


@pytest.mark.parametrize("filter_name", [f for f in OPERATIONS if "symmetrization" in f])
def test_masks_that_cannot_be_used(filter_name):
    shape = lump()
    assert_refused(shape.mesh_set(), filter_name, "nothing selected", only_selected=True)
    mesh_set = pymeshlab.MeshSet()
    quality = np.full(len(shape.points), 2.0)
    mesh_set.add_mesh(pymeshlab.Mesh(shape.points, shape.faces, v_scalar_array=quality))
    assert_refused(mesh_set, filter_name, "mask value 0 is 2; allowed is", weigh_by_quality=True)


def test_unknown_mirror_layer():
    mesh_set = cloud().mesh_set()
    assert_refused(mesh_set, "apply_mirror_reflection", "no layer 7", mirror_layer=7)
