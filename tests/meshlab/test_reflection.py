"""apply_mirror_reflection against the mirror that was found."""

from __future__ import annotations

import numpy as np
import pymeshlab
import pytest
from shapes import SHAPES, cloud, lump, lump_cloud, mesh

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")


@pytest.mark.parametrize("kind", SHAPES)
@pytest.mark.parametrize("method", symsurf.methods())
def test_the_layer_is_mirrored_over_the_mirror_found(method, kind):
    shape = SHAPES[kind](0)
    mirror = symsurf.detect(shape.points, method, faces=shape.faces).mirror
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_mirror_" + method)
    if mirror is None:
        with pytest.raises(pymeshlab.PyMeshLabException, match="holds no mirror"):
            mesh_set.apply_filter("apply_mirror_reflection")
        return
    returned = mesh_set.apply_filter("apply_mirror_reflection")
    images = mirror.reflect(shape.points)
    has_image = np.isfinite(images).all(axis=1)
    reflection = mesh_set[returned["reflection_layer"]]
    assert reflection.label() == "Reflection"
    assert returned["vertices"] == has_image.sum()
    atol = 1e-12 * shape.diagonal
    assert np.allclose(reflection.vertex_matrix(), images[has_image], rtol=0, atol=atol)
    if shape.faces is not None:
        assert reflection.face_number() == has_image[shape.faces].all(axis=1).sum()


def test_reflecting_turns_faces_round():
    shape = mesh(1)
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_mirror_plane")
    mesh_set.apply_filter("apply_mirror_reflection")
    before = mesh_set.apply_filter("get_geometric_measures")["mesh_volume"]
    mesh_set.set_current_mesh(len(mesh_set) - 1)
    after = mesh_set.apply_filter("get_geometric_measures")["mesh_volume"]
    assert after == pytest.approx(before, rel=1e-9) and before != 0


def test_reflecting_twice_gives_the_layer_back():
    shape = cloud(2)
    mesh_set = shape.mesh_set()
    mirror = mesh_set.apply_filter("compute_mirror_plane")["mirror_layer"]
    once = mesh_set.apply_filter("apply_mirror_reflection")["reflection_layer"]
    mesh_set.set_current_mesh(once)
    twice = mesh_set.apply_filter("apply_mirror_reflection", mirror_layer=mirror)
    points = mesh_set[twice["reflection_layer"]].vertex_matrix()
    assert np.allclose(points, shape.points, rtol=0, atol=1e-12 * shape.diagonal)


def test_another_layer_is_mirrored_where_it_is_shown():
    shape, other = cloud(3), cloud(4)
    mesh_set = shape.mesh_set()
    mirror = symsurf.detect(shape.points, "plane").mirror
    mesh_set.apply_filter("compute_mirror_plane")
    mesh_set.add_mesh(pymeshlab.Mesh(vertex_matrix=other.points), "other")
    matrix = np.eye(4)
    matrix[:3, 3] = 4, 5, 6
    mesh_set.apply_filter("set_matrix", transformmatrix=matrix, freeze=False)
    reflection = mesh_set[mesh_set.apply_filter("apply_mirror_reflection")["reflection_layer"]]
    images = mirror.reflect(other.points + (4, 5, 6))
    assert np.array_equal(reflection.transform_matrix(), np.eye(4))
    assert np.allclose(reflection.vertex_matrix(), images, rtol=0, atol=1e-12 * shape.diagonal)


def test_a_layer_without_mirror_is_refused():
    mesh_set = cloud(5).mesh_set()
    with pytest.raises(pymeshlab.PyMeshLabException, match="'shape' holds no mirror"):
        mesh_set.apply_filter("apply_mirror_reflection")
    assert len(mesh_set) == 1


def saved_and_read_again(mesh_set: pymeshlab.MeshSet, layer: int, file) -> None:
    mesh_set.set_current_mesh(layer)
    mesh_set.save_current_mesh(str(file))
    mesh_set.load_new_mesh(str(file))


@pytest.mark.parametrize(("method", "near"), [("plane", 1e-5), ("sphere", 1e-3)])
def test_a_mirror_that_was_saved_serves_again(method, near, tmp_path):
    shape = lump(6)
    mesh_set = shape.mesh_set()
    mirror = mesh_set.apply_filter("compute_mirror_" + method)["mirror_layer"]
    images = symsurf.detect(shape.points, method, faces=shape.faces).mirror.reflect(shape.points)
    saved_and_read_again(mesh_set, mirror, tmp_path / "mirror.ply")
    again = mesh_set.current_mesh().id()
    mesh_set.set_current_mesh(0)
    returned = mesh_set.apply_filter("apply_mirror_reflection", mirror_layer=again)
    reflected = mesh_set[returned["reflection_layer"]].vertex_matrix()
    images = images[np.isfinite(images).all(axis=1)]
    assert np.allclose(reflected, images, rtol=0, atol=near * shape.diagonal)


def test_a_mirror_that_was_moved_is_where_it_was_moved_to():
    shape = cloud(7)
    mesh_set = shape.mesh_set()
    mesh_set.set_current_mesh(mesh_set.apply_filter("compute_mirror_plane")["mirror_layer"])
    mirror = symsurf.detect(shape.points, "plane").mirror
    matrix = np.eye(4)
    matrix[:3, 3] = 2 * mirror.normal
    mesh_set.apply_filter("set_matrix", transformmatrix=matrix, freeze=True)
    mesh_set.set_current_mesh(0)
    returned = mesh_set.apply_filter("apply_mirror_reflection")
    reflected = mesh_set[returned["reflection_layer"]].vertex_matrix()
    images = mirror.reflect(shape.points) + 4 * mirror.normal
    assert np.allclose(reflected, images, rtol=0, atol=1e-9 * shape.diagonal)


def test_normals_of_a_reflected_mesh_are_its_own():
    shape = lump(8)
    normals = np.tile(shape.normal, (len(shape.points), 1))
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(shape.points, shape.faces, v_normals_matrix=normals))
    mesh_set.apply_filter("compute_mirror_plane")
    reflected = mesh_set[mesh_set.apply_filter("apply_mirror_reflection")["reflection_layer"]]
    outward = reflected.vertex_matrix() - reflected.vertex_matrix().mean(axis=0)
    assert ((reflected.vertex_normal_matrix() * outward).sum(axis=1) > 0).mean() > 0.9


DIRECTED = {
    "align": {},
    "straighten": {},
    "complete": {"search": False},
    "transfer": {},
}


@pytest.mark.parametrize("method", ["plane", "sphere", "cylinder", "perpendicular"])
@pytest.mark.parametrize("operation", ["reflect", *DIRECTED])
def test_directions_are_carried_as_in_python(operation, method):
    """Normals of a cloud, and an attribute of three numbers as a vector."""
    shape = lump_cloud(8)
    random = np.random.default_rng(0)
    normals, winds = random.normal(size=(2, *shape.points.shape))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(vertex_matrix=shape.points, v_normals_matrix=normals))
    mesh_set.current_mesh().add_vertex_custom_point_attribute(winds, "wind")
    found = mesh_set.apply_filter("compute_mirror_" + method)
    mirror = symsurf.detect(shape.points, method).mirror
    if operation == "reflect":
        returned = mesh_set.apply_filter("apply_mirror_reflection")
        layer = mesh_set[returned["reflection_layer"]]
        by = symsurf._core.AttributeTransform(mirror, shape.points)
        kept = np.isfinite(mirror.reflect(shape.points)).all(axis=1)
        expected = {kind: by(v, kind)[kept] for kind, v in (("vector", winds), ("normal", normals))}
    else:
        described = symsurf.operations()[operation]
        name = "apply_" + described.title.lower().replace(" ", "_")
        mesh_set.apply_filter(name, mirror_layer=found["mirror_layer"], **DIRECTED[operation])
        layer = mesh_set.current_mesh()
        given = [None] if operation == "transfer" else []
        made = getattr(symsurf, operation)(*given, shape.points, mirror, **DIRECTED[operation])
        expected = {
            "vector": made.carried(winds, "vector"),
            "normal": normals if operation == "transfer" else made.carried(normals, "normal"),
        }
    seen = layer.vertex_custom_point_attribute_matrix("wind")
    assert np.allclose(seen, expected["vector"], rtol=0, atol=1e-9)
    assert np.allclose(layer.vertex_normal_matrix(), expected["normal"], rtol=0, atol=1e-9)
