"""What the analyses leave in the document."""

from __future__ import annotations

import numpy as np
import pymeshlab
import pytest

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")


def box_set() -> pymeshlab.MeshSet:
    """A layer of a box with edges of 4, 3 and 2."""
    mesh_set = pymeshlab.MeshSet()
    mesh_set.create_cube(size=1)
    mesh_set.compute_matrix_from_translation_rotation_scale(
        scalex=4, scaley=3, scalez=2, freeze=True
    )
    return mesh_set


def labels(mesh_set: pymeshlab.MeshSet) -> list[str]:
    return [mesh.label() for mesh in mesh_set]


def test_planes_and_axes_become_layers() -> None:
    mesh_set = box_set()
    found = mesh_set.apply_filter("compute_symmetries")
    assert found["planes"] == 3 and found["axes"] == 3 and found["transformations"] == 8
    assert found["inversion"] is True
    np.testing.assert_array_equal(found["matrix_0"], np.eye(4))
    planes = [f"Symmetry plane {number}" for number in (1, 2, 3)]
    assert labels(mesh_set)[1:] == [*planes, "Symmetry axes"]
    axes = mesh_set.mesh(4)
    assert axes.vertex_number() == 6 and axes.edge_number() == 3
    directions = np.diff(axes.vertex_matrix().reshape(3, 2, 3), axis=1)[:, 0]
    lengths = np.abs(directions).max(axis=1)
    assert np.abs(directions).sum(axis=1) == pytest.approx(lengths, abs=1e-6)
    assert sorted(lengths) == pytest.approx([2.4, 3.6, 4.8])  # a tenth beyond, at each end
    # Each plane holds for a mirror.
    for number in (1, 2, 3):
        mesh_set.set_current_mesh(0)
        gaps = mesh_set.apply_filter("compute_mirror_asymmetry", mirror_layer=number)
        assert gaps["rms"] == pytest.approx(0, abs=1e-6)


def test_layers_take_the_place_of_those_before() -> None:
    mesh_set = box_set()
    mesh_set.apply_filter("compute_symmetries")
    before = labels(mesh_set)
    mesh_set.set_current_mesh(0)
    mesh_set.apply_filter("compute_symmetries")
    assert labels(mesh_set) == before


def test_bad_input_is_named_and_the_host_lives() -> None:
    mesh_set = box_set()
    with pytest.raises(pymeshlab.PyMeshLabException, match=r"allowed is real \[0, 1\]"):
        mesh_set.apply_filter("compute_symmetries", minimum_score=2.0)
    assert labels(mesh_set) == labels(box_set())
    mesh_set.add_mesh(pymeshlab.Mesh(np.zeros((5, 3))))
    with pytest.raises(pymeshlab.PyMeshLabException, match="points are equal"):
        mesh_set.apply_filter("compute_symmetries")


@pytest.mark.parametrize("name", symsurf.analyses())
def test_every_analysis_gives_the_vertices_what_it_describes(name: str) -> None:
    mesh_set = box_set()
    mesh_set.apply_filter(f"compute_{name}")
    mesh = mesh_set.mesh(0)
    for array in symsurf.analyses()[name].arrays:
        names = [array.name]
        if array.components not in (1, 3):
            names = [f"{array.name}_{column}" for column in range(array.components)]
        for name_ in names:
            if array.components == 3:
                assert len(mesh.vertex_custom_point_attribute_matrix(name_)) == 8
            else:
                assert len(mesh.vertex_custom_scalar_attribute_array(name_)) == 8


def test_a_layer_is_laid_on_another_and_compared_with_it() -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(2000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    x, y, z = points.T
    points *= np.exp(0.2 * (np.sin(3 * x + 1) + np.cos(4 * y - z) + np.sin(2 * z + 2 * x * y)))[:, None]  # fmt: skip
    matrix = np.array([[0, 0, 1, 3], [0, -1, 0, 1], [-1, 0, 0, 2], [0, 0, 0, 1.0]])
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(points))
    mesh_set.add_mesh(pymeshlab.Mesh(points @ matrix[:3, :3].T + matrix[:3, 3]))
    mesh_set.set_current_mesh(0)
    found = mesh_set.apply_filter("compute_match_pair", other_layer=1)
    assert found["score"] > 0.99
    np.testing.assert_allclose(found["matrix_0"], matrix, atol=1e-6)
    gaps = mesh_set.apply_filter("compute_mirror_asymmetry", other_layer=1)
    assert gaps["maximum"] < 1e-6 and "mirror_layer" not in gaps
    assert len(mesh_set) == 2
