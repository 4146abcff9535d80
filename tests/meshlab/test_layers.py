"""Which layers there are after a filter, and which is the current one."""

from __future__ import annotations

import numpy as np
import pymeshlab
import pytest
from shapes import box, cloud, lump

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")

OPERATIONS = [
    "compute_mirror_asymmetry",
    "compute_mirror_correspondences",
    "apply_mirror_alignment",
    "apply_mirror_completion",
    "apply_mirror_symmetrization",
    "apply_mirror_straightening",
]


def labels(mesh_set: pymeshlab.MeshSet) -> list[str]:
    return [m.label() for m in mesh_set]


def layer(mesh_set: pymeshlab.MeshSet, name: str) -> pymeshlab.Mesh:
    (found,) = [m for m in mesh_set if m.label() == name]
    return found


def test_a_second_run_replaces_the_first():
    mesh_set = box(0).mesh_set()
    for _ in range(3):
        returned = mesh_set.apply_filter("compute_mirror_plane", show_candidates=True)
    candidates = [f"Candidate mirror {i}, score 1.00" for i in (1, 2)]
    assert labels(mesh_set) == ["shape", "Mirror", "Surface points", *candidates]
    assert mesh_set[returned["mirror_layer"]].label() == "Mirror"
    assert mesh_set.current_mesh().label() == "shape"


def test_the_results_of_other_methods_and_layers_stay():
    mesh_set = lump(1).mesh_set()
    plane = mesh_set.apply_filter("compute_mirror_plane")["mirror_layer"]
    sphere = mesh_set.apply_filter("compute_mirror_sphere")["mirror_layer"]
    mesh_set.add_mesh(pymeshlab.Mesh(cloud(1).points), "other")
    other = mesh_set.apply_filter("compute_mirror_plane")["mirror_layer"]
    assert len({plane, sphere, other}) == 3
    assert [mesh_set[i].label() for i in (plane, sphere, other)] == [
        "Mirror",
        "Mirror(1)",
        "Mirror(2)",
    ]
    assert mesh_set.current_mesh().label() == "other"


def test_a_layer_with_another_name_stays():
    mesh_set = lump(2).mesh_set()
    mesh_set[mesh_set.apply_filter("compute_mirror_plane")["mirror_layer"]].set_label("kept")
    mesh_set.apply_filter("compute_mirror_plane")
    assert labels(mesh_set) == ["shape", "kept", "Mirror", "Surface points"]


def test_surface_points_are_hidden_behind_a_mirror_and_never_empty():
    mesh_set = lump(3).mesh_set()
    mesh_set.apply_filter("compute_mirror_plane")
    assert not layer(mesh_set, "Surface points").is_visible()
    assert layer(mesh_set, "Mirror").is_visible() and layer(mesh_set, "shape").is_visible()

    mesh_set = lump(3).mesh_set()
    mesh_set.apply_filter("compute_mirror_normals_only")
    assert labels(mesh_set) == ["shape", "Mirror", "Surface points"]

    # No curved mirror maps a flat sheet along one direction: nothing is paired.
    rng = np.random.default_rng(3)
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(rng.normal(size=(200, 3)) * (1, 1, 1e-3)), "shape")
    returned = mesh_set.apply_filter("compute_mirror_fixed_direction")
    assert returned["pairs"] == 0 and labels(mesh_set) == ["shape"]
    assert "surface_points_layer" not in returned


def test_low_residuals_are_blue():
    shape = lump(4)
    shape.points[100] += 0.02 * shape.diagonal * shape.normal
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_mirror_plane", use_faces=False)
    marked = layer(mesh_set, "shape")
    quality, colours = marked.vertex_scalar_array(), marked.vertex_color_matrix()[:, :3]
    exact = (quality >= 0) & (quality < 1e-6 * shape.diagonal)
    assert exact.mean() > 0.9 and np.allclose(colours[exact], (0, 0, 1), atol=0.02)
    assert np.allclose(colours[quality.argmax()], (1, 0, 0), atol=0.02)


@pytest.mark.parametrize("operation", OPERATIONS)
def test_an_operation_finds_the_mirror_once(operation):
    mesh_set = lump(5).mesh_set()
    first = mesh_set.apply_filter(operation)
    assert labels(mesh_set) == ["shape", "Mirror"]
    second = mesh_set.apply_filter(operation)
    assert labels(mesh_set) == ["shape", "Mirror"]
    assert first["mirror_layer"] == second["mirror_layer"]
    mesh_set.apply_filter(operation, find_mirror=True)
    assert labels(mesh_set) == ["shape", "Mirror"]
    assert mesh_set.current_mesh().label() == "shape"
    # What the method's own filter finds takes its place.
    mesh_set.apply_filter("compute_mirror_auto")
    assert labels(mesh_set) == ["shape", "Mirror", "Surface points"]


def test_the_mirror_of_another_layer_is_not_taken_unasked():
    mesh_set = lump(6).mesh_set()
    mesh_set.apply_filter("compute_mirror_plane")
    other = lump(7)
    mesh_set.add_mesh(pymeshlab.Mesh(other.points, other.faces), "other")
    returned = mesh_set.apply_filter("compute_mirror_asymmetry")
    assert mesh_set[returned["mirror_layer"]].label() == "Mirror(1)"
    assert returned["maximum"] < 1e-9 * other.diagonal


@pytest.mark.parametrize("scale", (1, 3))
def test_the_mirror_is_where_it_is_shown(scale):
    shape = lump(8)
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_mirror_plane")
    turn = np.eye(4)
    turn[:3] = [(0, -scale, 0, 4), (scale, 0, 0, 5), (0, 0, scale, 6)]
    points = np.linalg.solve(turn[:3, :3], (shape.points - turn[:3, 3]).T).T
    mesh_set.add_mesh(pymeshlab.Mesh(points, shape.faces), "turned")
    mesh_set.apply_filter("set_matrix", transformmatrix=turn, freeze=False)
    mirror = layer(mesh_set, "Mirror").id()
    returned = mesh_set.apply_filter("compute_mirror_asymmetry", mirror_layer=mirror)
    assert returned["maximum"] < 1e-9 * shape.diagonal / scale and returned["matched_share"] == 1
    # In place, in the layer's own coordinates.
    before = mesh_set.current_mesh().vertex_matrix()
    mesh_set.apply_filter("apply_mirror_symmetrization", mirror_layer=mirror)
    after = mesh_set.current_mesh().vertex_matrix()
    assert np.allclose(after, before, rtol=0, atol=1e-9 * shape.diagonal)


def test_a_reflection_becomes_the_current_layer():
    mesh_set = lump(9).mesh_set()
    mesh_set.apply_filter("compute_mirror_plane")
    for name in ("Reflection", "Reflection(1)"):
        returned = mesh_set.apply_filter("apply_mirror_reflection")
        assert mesh_set.current_mesh().label() == name
        assert mesh_set.current_mesh_id() == returned["reflection_layer"]
