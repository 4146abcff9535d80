"""The other mirrors that were found: returned values, and layers when asked for."""

from __future__ import annotations

import numpy as np
import pymeshlab
import pytest
from shapes import Shape, box

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")


def prism(seed: int, sides: int) -> Shape:
    """Right and regular: each side has its plane, and one more lies across."""
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle), np.full(sides, -1)], axis=1)
    points = np.vstack([ring, ring * (1, 1, -1), [(0, 0, -1), (0, 0, 1)]])
    i, j = np.arange(sides), (np.arange(sides) + 1) % sides
    walls = [np.stack([i, j, sides + j], 1), np.stack([i, sides + j, sides + i], 1)]
    bottom = np.stack([np.full(sides, 2 * sides), j, i], 1)
    top = np.stack([np.full(sides, 2 * sides + 1), sides + i, sides + j], 1)
    return Shape(points, np.vstack([*walls, bottom, top]), seed)


def candidate_layers(mesh_set: pymeshlab.MeshSet) -> list[pymeshlab.Mesh]:
    return [m for m in mesh_set if m.label().startswith("Candidate mirror")]


@pytest.mark.parametrize("seed", (0, 1))
@pytest.mark.parametrize(
    ("shape_of", "planes"), [(box, 3), (lambda s: prism(s, 3), 4), (lambda s: prism(s, 6), 7)]
)
def test_returned_values_are_those_of_python(shape_of, planes, seed):
    shape = shape_of(seed)
    expected = symsurf.detect(shape.points, "plane", faces=shape.faces).candidates
    returned = shape.mesh_set().apply_filter("compute_mirror_plane")
    assert returned["candidates"] == len(expected) == planes - 1
    assert np.allclose(returned["candidate_scores"], 1)
    near = {"rtol": 0, "atol": 1e-12 * shape.diagonal}
    normals = returned["candidate_normals"].reshape(-1, 3)
    assert np.allclose(normals, [c.mirror.normal for c in expected], **near)
    assert np.allclose(returned["candidate_offsets"], [c.mirror.offset for c in expected], **near)


def test_each_candidate_has_a_layer_when_asked_for():
    shape = box(2)
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_mirror_plane")
    assert candidate_layers(mesh_set) == []

    mesh_set = shape.mesh_set()
    returned = mesh_set.apply_filter("compute_mirror_plane", show_candidates=True)
    layers = candidate_layers(mesh_set)
    assert [m.label() for m in layers] == [f"Candidate mirror {i}, score 1.00" for i in (1, 2)]
    normals = returned["candidate_normals"].reshape(-1, 3)
    for drawn, normal, offset in zip(layers, normals, returned["candidate_offsets"]):
        assert drawn.face_number() > 0
        assert np.allclose(drawn.vertex_matrix() @ normal + offset, 0, atol=1e-9)
    assert mesh_set[returned["mirror_layer"]].label() == "Mirror"
    assert mesh_set.current_mesh().label() == "shape"


def test_the_layer_can_be_reflected_over_a_candidate():
    shape = box(3)
    mesh_set = shape.mesh_set()
    returned = mesh_set.apply_filter("compute_mirror_plane", show_candidates=True)
    number = next(m.id() for m in candidate_layers(mesh_set))
    mirror = symsurf.Plane(returned["candidate_normals"][:3], returned["candidate_offsets"][0])
    for layer, over in [
        (number, mirror),
        (None, symsurf.Plane(returned["normal"], returned["offset"])),
    ]:
        chosen = {} if layer is None else {"mirror_layer": layer}
        reflected = mesh_set.apply_filter("apply_mirror_reflection", **chosen)["reflection_layer"]
        points = mesh_set[reflected].vertex_matrix()
        mesh_set.set_current_mesh(0)
        assert np.allclose(points, over.reflect(shape.points), rtol=0, atol=1e-9)


def test_candidates_of_other_kinds_have_scores():
    shape = box(4)
    expected = symsurf.detect(shape.points, "sphere", faces=shape.faces).candidates
    mesh_set = shape.mesh_set()
    returned = mesh_set.apply_filter("compute_mirror_sphere", show_candidates=True)
    assert returned["candidates"] == len(expected) > 0
    assert np.allclose(returned["candidate_scores"], [c.score for c in expected], atol=1e-12)
    assert "candidate_normals" not in returned
    assert len(candidate_layers(mesh_set)) == len(expected)
