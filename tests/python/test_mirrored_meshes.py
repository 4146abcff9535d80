"""The frame of a plane, and the images of whole meshes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import symsurf

pyvista = pytest.importorskip("pyvista")

PLANE = symsurf.Plane((1, 2, -2), 3)
SPHERE = symsurf.Sphere((5, 0, 0), 4)
numbers = st.floats(-1e3, 1e3)


@given(st.tuples(numbers, numbers, numbers).filter(lambda v: np.linalg.norm(v) > 1e-3), numbers)
def test_frame_of_a_plane(normal, offset):
    plane = symsurf.Plane(normal, offset)
    np.testing.assert_allclose(plane.axes @ plane.axes.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(plane.axes) == pytest.approx(1)
    np.testing.assert_array_equal(plane.axes[2], plane.normal)
    assert plane.axes[0][np.abs(plane.normal).argmin()] == 0
    np.testing.assert_allclose(np.cross(plane.origin, plane.normal), 0, atol=1e-9)
    reach = max(1, abs(plane.offset))
    assert abs(plane.signed_distance(plane.origin[None])[0]) < 1e-14 * reach
    again = symsurf.Plane(plane.normal, -plane.normal @ plane.origin)
    assert abs(again.offset - plane.offset) < 1e-14 * reach


def ball():
    mesh = pyvista.ParametricSuperEllipsoid(xradius=1, yradius=0.5, zradius=0.25).clean()
    mesh.clear_data()
    return mesh.triangulate()


def volume(shape):
    """Positive where the faces are wound outwards."""
    a, b, c = (shape.points[shape.faces[:, corner]] for corner in range(3))
    return np.einsum("ij,ij", a, np.cross(b, c)) / 6


def quads():
    return pyvista.Cube(x_length=1, y_length=2, z_length=3).clean()


def strips():
    return ball().strip()


def grid():
    return quads().cast_to_unstructured_grid()


def mesh_of_trimesh():
    trimesh = pytest.importorskip("trimesh")
    mesh = ball()
    return trimesh.Trimesh(np.asarray(mesh.points), mesh.regular_faces, process=False)


def as_shape(mesh):
    if isinstance(mesh, pyvista.DataSet):
        return symsurf.Shape.from_pyvista(mesh)
    return symsurf.Shape(np.asarray(getattr(mesh, "points", None) if isinstance(mesh, symsurf.Shape)
                                    else mesh.vertices, float), np.asarray(mesh.faces))  # fmt: skip


@pytest.mark.parametrize("mirror", [PLANE, SPHERE], ids=["plane", "sphere"])
@pytest.mark.parametrize(
    "make", [lambda: symsurf.Shape.from_pyvista(ball()), ball, quads, strips, grid, mesh_of_trimesh],
    ids=["Shape", "PolyData", "quads", "strips", "UnstructuredGrid", "trimesh"],
)  # fmt: skip
def test_the_image_of_a_mesh_is_one_of_its_kind_wound_outwards(make, mirror):
    mesh = make()
    before, image = as_shape(mesh), mirror.reflect(mesh)
    assert type(image) is type(mesh)
    after = as_shape(image)
    points = mirror.reflect(before.points)
    np.testing.assert_allclose(after.points, points, atol=1e-6)  # PyVista's may be float32
    assert after.faces.shape == before.faces.shape
    if make is not quads and make is not grid:  # whose triangles PyVista makes
        faces = (sorted(map(sorted, each.faces.tolist())) for each in (before, after))
        assert next(faces) == next(faces)
    sign = np.sign(volume(before))
    assert sign * volume(after) > 0
    if mirror is PLANE:
        assert volume(after) == pytest.approx(volume(before), rel=1e-5)
    again = as_shape(mirror.reflect(image))
    np.testing.assert_allclose(again.points, before.points, atol=1e-5)


def test_attributes_stay_and_normals_go():
    mesh = pyvista.Sphere()
    mesh["height"] = mesh.points[:, 2]
    mesh.cell_data["number"] = np.arange(mesh.n_cells)
    mesh.field_data["name"] = ["ball"]
    assert mesh.point_data.active_normals is not None
    image = PLANE.reflect(mesh)
    np.testing.assert_array_equal(image["height"], mesh["height"])
    np.testing.assert_array_equal(image.cell_data["number"], mesh.cell_data["number"])
    assert list(image.field_data["name"]) == ["ball"]
    assert image.point_data.active_normals is None
    assert mesh.point_data.active_normals is not None  # of the mesh that was given they stay
    assert PLANE.reflect(symsurf.Shape(mesh.points, None, mesh.points)).normals is None


def test_clouds_have_images_too():
    points = np.asarray(ball().points, dtype=float)
    for cloud in (symsurf.Shape(points), pyvista.PolyData(points)):
        image = PLANE.reflect(cloud)
        assert type(image) is type(cloud)
        np.testing.assert_array_equal(image.points, PLANE.reflect(points))
    assert isinstance(PLANE.reflect(points.tolist()), np.ndarray)
    assert isinstance(PLANE.project(pyvista.PolyData(points)), np.ndarray)


def test_volumes_have_none():
    for mesh in (pyvista.ImageData(dimensions=(2, 2, 2)), pyvista.Sphere().delaunay_3d()):
        with pytest.raises(symsurf.InvalidInput, match="give a surface"):
            PLANE.reflect(mesh)
