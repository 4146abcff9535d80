"""Every failure is a sentence; the host lives on and the document is as it was."""

from __future__ import annotations

import math
import re

import numpy as np
import pymeshlab
import pytest
from bad_input import tables
from shapes import cloud, mesh

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")


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
        for attribute in ("partner", "side"):
            with pytest.raises(pymeshlab.PyMeshLabException):
                mesh_set.current_mesh().vertex_custom_scalar_attribute_array(attribute)
    assert cloud(9).mesh_set().apply_filter("compute_mirror_plane")["pairs"] > 0


def layer(points) -> pymeshlab.MeshSet:
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(vertex_matrix=np.asarray(points, float)), "layer")
    return mesh_set


# A layer without vertices is another case: MeshLab has none to begin with. A filter always leaves
# out points that are not finite. A percentage of the extent of "just too large" is beyond the single
# precision in which pymeshlab passes it on.
CLOUDS = [
    pytest.param(cloud, id=cloud.name)
    for cloud in tables.clouds()
    if cloud.points and not cloud.refuses_nonfinite and cloud.name != "just too large"
]


@pytest.mark.parametrize("bad", CLOUDS)
@pytest.mark.parametrize("method", symsurf.methods())
def test_layers_that_cannot_be_used(method, bad):
    assert_refused(layer(bad.points), "compute_mirror_" + method, re.escape(bad.reason))


@pytest.mark.parametrize("method", symsurf.methods())
def test_no_layer(method):
    assert_refused(pymeshlab.MeshSet(), "compute_mirror_" + method, "requires at least one mesh")


@pytest.mark.parametrize("method", symsurf.methods())
def test_all_vertices_removed(method):
    mesh_set = mesh().mesh_set()
    mesh_set.apply_filter("set_selection_all")
    mesh_set.apply_filter("meshing_remove_selected_vertices")
    assert_refused(mesh_set, "compute_mirror_" + method, "'shape' has no vertices")


def numbers_out_of_range():
    for method in symsurf.methods().values():
        for p in method.parameters:
            if p.type not in ("integer", "real"):
                continue
            outside = [v for v in (p.minimum - 1, p.maximum + 1) if abs(v) < 2**31]
            for value in outside if p.type == "integer" else [*outside, math.inf, math.nan]:
                yield pytest.param(method.name, p, value, id=f"{method.name}-{p.name}-{value}")


@pytest.mark.parametrize(("method", "p", "value"), list(numbers_out_of_range()))
def test_numbers_out_of_range(method, p, value):
    shape = cloud()
    if p.type == "integer":
        value = int(value)
    elif p.unit == "diagonal":
        value = pymeshlab.PureValue(value * shape.diagonal)
    sentence = f"{p.name} is .*; allowed is {p.type} "
    assert_refused(shape.mesh_set(), "compute_mirror_" + method, sentence, **{p.name: value})


def choices():
    for method in symsurf.methods().values():
        yield from ((method.name, p.name) for p in method.parameters if p.type == "choice")


@pytest.mark.parametrize(("method", "name"), list(choices()))
def test_unknown_choice(method, name):
    filter_name = "compute_mirror_" + method
    assert_refused(cloud().mesh_set(), filter_name, "not-there", **{name: "not-there"})


@pytest.mark.parametrize("method", symsurf.methods())
def test_common_parameters(method):
    filter_name = "compute_mirror_" + method
    for name in ("seed", "threads"):
        sentence = f"{name} is -1; allowed is integer"
        assert_refused(cloud().mesh_set(), filter_name, sentence, **{name: -1})
    assert_refused(cloud().mesh_set(), filter_name, "nothing selected", only_selected=True)
    assert_refused(cloud().mesh_set(), filter_name, "are all zero", use_normals=True)


def test_unknown_mirror_layer():
    mesh_set = cloud().mesh_set()
    assert_refused(mesh_set, "apply_mirror_reflection", "no layer 7", mirror_layer=7)
