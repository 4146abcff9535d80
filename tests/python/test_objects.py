"""Meshes, clouds and tables of other packages, as they come and as they are given back."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from symmetric_shapes import random_rotation

import symsurf

HEIGHTS = "heights"


class Kind(NamedTuple):
    """How a package has a mesh or a cloud, with a number a point where it has room."""

    make: Callable[[Any, Any, Any], Any]
    """Of points, faces and heights; of a cloud without the faces."""
    points: Callable[[Any], Any]
    faces: Callable[[Any], Any]
    values: Callable[[Any, str], Any]
    """Of the points, by name."""
    has_faces: bool = True
    has_arrays: bool = True


def nothing(*_: Any) -> None:
    return None


def trimesh_kinds():
    trimesh = pytest.importorskip("trimesh", reason="needs trimesh")

    def mesh(points, faces, heights):
        made = trimesh.Trimesh(points, faces, process=False, metadata={"name": "part"})
        made.vertex_attributes[HEIGHTS] = heights
        return made

    yield Kind(
        mesh, lambda m: m.vertices, lambda m: m.faces, lambda m, name: m.vertex_attributes[name]
    )
    yield Kind(
        lambda points, *_: trimesh.PointCloud(points), lambda m: m.vertices, nothing, nothing,
        has_faces=False, has_arrays=False,
    )  # fmt: skip


def open3d_kinds():
    open3d = pytest.importorskip("open3d", reason="needs Open3D")
    vectors, corners = open3d.utility.Vector3dVector, open3d.utility.Vector3iVector

    def tensors(points, faces, heights):
        made = open3d.t.geometry.TriangleMesh(points, faces)
        made.vertex[HEIGHTS] = heights
        return made

    def tensor_cloud(points, faces, heights):
        made = open3d.t.geometry.PointCloud(points)
        made.point[HEIGHTS] = heights
        return made

    yield Kind(
        lambda points, faces, _: open3d.geometry.TriangleMesh(vectors(points), corners(faces)),
        lambda m: m.vertices, lambda m: m.triangles, nothing, has_arrays=False,
    )  # fmt: skip
    yield Kind(
        lambda points, *_: open3d.geometry.PointCloud(vectors(points)),
        lambda m: m.points, nothing, nothing, has_faces=False, has_arrays=False,
    )  # fmt: skip
    yield Kind(
        tensors, lambda m: m.vertex.positions.numpy(), lambda m: m.triangle.indices.numpy(),
        lambda m, name: m.vertex[name].numpy(),
    )  # fmt: skip
    yield Kind(
        tensor_cloud, lambda m: m.point.positions.numpy(), nothing,
        lambda m, name: m.point[name].numpy(), has_faces=False,
    )  # fmt: skip


def itk_kinds():
    itk = pytest.importorskip("itk", reason="needs ITK")

    def filled(empty, points, heights):
        empty.SetPoints(itk.vector_container_from_array(points.astype(np.float32).ravel()))
        empty.SetPointData(itk.vector_container_from_array(heights.astype(np.float32)))
        return empty

    def mesh(points, faces, heights):
        made = filled(itk.Mesh[itk.F, 3].New(), points, heights)
        cells = np.hstack([np.tile((2, 3), (len(faces), 1)), faces]).astype(np.uint64)
        made.SetCellsArray(itk.vector_container_from_array(cells.ravel()))
        return made

    def points_of(made):
        return itk.array_from_vector_container(made.GetPoints())

    def faces_of(made):
        return itk.array_from_vector_container(made.GetCellsArray()).reshape(-1, 5)[:, 2:]

    def values(made, name):
        return itk.array_from_vector_container(made.GetPointData()) if name == HEIGHTS else None

    yield Kind(mesh, points_of, faces_of, values, has_arrays=False)
    yield Kind(
        lambda points, _, heights: filled(itk.PointSet[itk.F, 3].New(), points, heights),
        points_of, nothing, values, has_faces=False, has_arrays=False,
    )  # fmt: skip


def meshio_kinds():
    meshio = pytest.importorskip("meshio", reason="needs meshio")
    yield Kind(
        lambda points, faces, heights: meshio.Mesh(
            points, [("triangle", faces)], point_data={HEIGHTS: heights}
        ),
        lambda m: m.points, lambda m: m.cells_dict["triangle"],
        lambda m, name: m.point_data[name],
    )  # fmt: skip


def table_kinds():
    for package in ("pandas", "polars"):
        tables = pytest.importorskip(package, reason=f"needs {package}")

        def table(points, faces, heights, tables=tables):
            columns = dict(zip("xyz", np.array(points).T))
            names = [f"point {i}" for i in range(len(points))]
            return tables.DataFrame({"name": names, **columns, HEIGHTS: heights})

        yield Kind(
            table, lambda t: np.column_stack([t[axis] for axis in "xyz"]), nothing,
            lambda t, name: np.asarray(t[name]), has_faces=False,
        )  # fmt: skip


def pyvista_kinds():
    pyvista = pytest.importorskip("pyvista", reason="needs PyVista")

    def mesh(points, faces, heights):
        made = pyvista.PolyData.from_regular_faces(points, faces)
        made[HEIGHTS] = heights
        return made

    yield Kind(
        mesh, lambda m: m.points, lambda m: m.regular_faces, lambda m, name: m.point_data[name]
    )


PACKAGES = {
    "trimesh": trimesh_kinds,
    "open3d": open3d_kinds,
    "itk": itk_kinds,
    "meshio": meshio_kinds,
    "tables": table_kinds,
    "pyvista": pyvista_kinds,
}


@pytest.fixture(params=PACKAGES)
def kinds(request) -> list[Kind]:
    return list(PACKAGES[request.param]())


@pytest.fixture(scope="module")
def shape() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """An ellipsoid with a bump on one side, turned; a height a point, the same on both sides."""
    longitude, latitude = np.meshgrid(np.arange(40) * np.pi / 20, np.linspace(0.05, 3.09, 20))
    ring = np.sin(latitude)
    points = np.stack(
        [ring * np.cos(longitude), 2 * ring * np.sin(longitude), 3 * np.cos(latitude)], -1
    )
    points = points.reshape(-1, 3)
    points[:, 1] += 0.3 * points[:, 2] ** 2
    heights = points[:, 2].copy()
    corner = np.arange(19 * 40).reshape(19, 40)
    right = np.roll(corner, -1, axis=1)
    faces = np.concatenate([
        np.stack([corner, right, right + 40], -1).reshape(-1, 3),
        np.stack([corner, right + 40, corner + 40], -1).reshape(-1, 3),
    ])  # fmt: skip
    return points @ random_rotation(np.random.default_rng(4)).T + (5, 2, 1), faces, heights


def volume_of(points, faces) -> float:
    """Positive where the faces are wound so that their normals point outward."""
    return np.linalg.det(np.asarray(points, float)[np.asarray(faces)]).sum() / 6


def given(kind: Kind, shape) -> Any:
    points, faces, heights = shape
    return kind.make(points.copy(), faces.copy(), heights.copy())


def own_faces(kind: Kind, shape) -> Any:
    return shape[1] if kind.has_faces else None


def test_they_are_what_their_arrays_are(kinds, shape):
    for kind in kinds:
        made = given(kind, shape)
        plain = symsurf.detect_plane(kind.points(made), faces=own_faces(kind, shape))
        result = symsurf.detect_plane(made)
        assert repr(result.mirror) == repr(plain.mirror) and result.score == plain.score
        np.testing.assert_array_equal(result.faces, plain.faces)
        expected = symsurf.asymmetry(kind.points(made), plain, faces=own_faces(kind, shape))
        np.testing.assert_array_equal(symsurf.asymmetry(made, result).signed, expected.signed)
        assert symsurf.symmetries(made).group == symsurf.symmetries(symsurf.Shape(
            np.asarray(kind.points(made), float), own_faces(kind, shape))).group  # fmt: skip
        for function in (result.mirror.signed_distance, result.mirror.project):
            np.testing.assert_array_equal(function(made), function(kind.points(made)))


def test_the_image_is_of_the_same_type(kinds, shape):
    mirror = symsurf.Plane((1, 2, 3), 4)
    for kind in kinds:
        made = given(kind, shape)
        image = mirror.reflect(made)
        assert type(image) is type(made)
        np.testing.assert_allclose(kind.points(image), mirror.reflect(shape[0]), atol=1e-5)
        if kind.has_faces:
            volume = volume_of(kind.points(image), kind.faces(image))
            assert volume == pytest.approx(volume_of(shape[0], shape[1]), rel=1e-4)
        if kind.values is not nothing:
            np.testing.assert_allclose(kind.values(image, HEIGHTS), shape[2], atol=1e-6)
        np.testing.assert_allclose(kind.points(made), shape[0], atol=1e-6)  # stays as it is


def test_operations_give_the_same_type_with_its_attributes(kinds, shape):
    for kind in kinds:
        made = given(kind, shape)
        mirror = symsurf.detect_plane(made).mirror
        measured = symsurf.asymmetry(made, mirror)
        back = measured.like(made)
        assert type(back) is type(made)
        np.testing.assert_array_equal(kind.points(back), kind.points(made))
        if kind.has_arrays:
            np.testing.assert_array_equal(kind.values(back, "signed"), measured.signed)
        upright = symsurf.align(made, mirror)
        back = upright.like(made)
        np.testing.assert_allclose(kind.points(back), upright.shape.points, atol=1e-5)
        if kind.values is not nothing:
            np.testing.assert_allclose(kind.values(back, HEIGHTS), shape[2], atol=1e-6)


def test_what_is_added_has_the_attributes_of_its_source(kinds, shape):
    points, faces, heights = shape
    mirror = symsurf.detect_plane(points, faces=faces).mirror
    side = mirror.signed_distance(points)
    kept = side < 0.7 * side.max()
    number = np.cumsum(kept) - 1
    broken = points[kept], number[faces[kept[faces].all(axis=1)]], heights[kept]
    for kind in kinds:
        made = kind.make(*broken)
        whole = symsurf.complete(made, mirror)
        back = whole.like(made)
        assert type(back) is type(made)
        assert len(kind.points(back)) == len(whole.shape.points) > len(broken[0])
        if kind.has_faces:
            np.testing.assert_array_equal(kind.faces(back), whole.shape.faces)
        if kind.values is not nothing:
            np.testing.assert_allclose(
                kind.values(back, HEIGHTS), broken[2][whole.sources], atol=1e-6
            )


def test_another_object_is_refused(kinds, shape):
    points = shape[0]
    for kind in kinds:
        upright = symsurf.align(points[:-40], symsurf.Plane((1, 0, 0), 0))
        with pytest.raises(symsurf.InvalidInput, match="has 800 points; allowed is the one"):
            upright.like(given(kind, shape))
    with pytest.raises(
        symsurf.InvalidInput, match="of type ndarray; allowed are pyvista.DataSet, "
    ):
        upright.like(points)
    with pytest.raises(symsurf.InvalidInput, match="points are of type dict; allowed are an array"):
        symsurf.detect({})


# What one package alone has


def test_trimesh_keeps_colours_textures_and_scenes(shape):
    trimesh = pytest.importorskip("trimesh", reason="needs trimesh")
    points, faces, _ = shape
    mirror = symsurf.Plane((1, 0, 0), 0)
    colours = np.random.default_rng(0).integers(0, 255, (len(points), 4), np.uint8)
    mesh = trimesh.Trimesh(points, faces, process=False, vertex_colors=colours)
    np.testing.assert_array_equal(mirror.reflect(mesh).visual.vertex_colors, colours)
    face_colours = np.random.default_rng(0).integers(0, 255, (len(faces), 4), np.uint8)
    mesh = trimesh.Trimesh(points, faces, process=False, face_colors=face_colours)
    np.testing.assert_array_equal(mirror.reflect(mesh).visual.face_colors, face_colours)
    uv = np.random.default_rng(0).random((len(points), 2))
    mesh.visual = trimesh.visual.TextureVisuals(uv=uv)
    np.testing.assert_array_equal(symsurf.align(mesh, mirror).like(mesh).visual.uv, uv)
    scene = trimesh.Scene([mesh, mesh.copy().apply_translation((9, 0, 0))])
    assert symsurf.detect_plane(scene).points.shape == (2 * len(points), 3)


def test_pandas_keeps_rows_and_kinds_of_columns(shape):
    pandas = pytest.importorskip("pandas", reason="needs pandas")
    points, _, _ = shape
    table = pandas.DataFrame(points, columns=["X", "Y", "Z"], index=np.arange(len(points)) * 3)
    table["tissue"] = pandas.Categorical(["bone", "skin"] * (len(points) // 2))
    result = symsurf.detect_plane(table)
    back = symsurf.align(table, result).like(table)
    assert list(back.columns) == list(table.columns) and back.index.equals(table.index)
    assert back.dtypes.equals(table.dtypes) and back["tissue"].equals(table["tissue"])
    named = table.rename(columns={"X": "a", "Y": "b", "Z": "c"})
    assert repr(symsurf.detect_plane(named).mirror) == repr(result.mirror)
    named["d"] = 1.0
    with pytest.raises(
        symsurf.InvalidInput, match="columns of the DataFrame are a, b, c, tissue, d"
    ):
        symsurf.detect_plane(named)


def test_open3d_keeps_colours_and_textures(shape):
    open3d = pytest.importorskip("open3d", reason="needs Open3D")
    points, faces, _ = shape
    vectors = open3d.utility.Vector3dVector
    mesh = open3d.geometry.TriangleMesh(vectors(points), open3d.utility.Vector3iVector(faces))
    colours = np.random.default_rng(0).random((len(points), 3))
    mesh.vertex_colors = vectors(colours)
    by_corner = np.random.default_rng(1).random((len(faces), 3, 2))
    mesh.triangle_uvs = open3d.utility.Vector2dVector(by_corner.reshape(-1, 2))
    mesh.compute_vertex_normals()
    mirror = symsurf.Plane((1, 0, 0), 0)
    image = mirror.reflect(mesh)
    np.testing.assert_array_equal(image.vertex_colors, colours)
    turned = np.asarray(image.triangle_uvs).reshape(-1, 3, 2)
    np.testing.assert_array_equal(turned, by_corner[:, [0, 2, 1]])
    assert not image.has_vertex_normals()
    assert symsurf.asymmetry(mesh, mirror).like(mesh).has_vertex_normals()
    tensors = open3d.t.geometry.TriangleMesh.from_legacy(mesh)
    image = mirror.reflect(tensors)
    assert "normals" not in image.vertex and "normals" in tensors.vertex
    np.testing.assert_allclose(image.triangle.texture_uvs.numpy(), turned, atol=1e-6)


def test_polygons_of_itk_and_meshio_are_divided():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], float)
    quads = np.array(
        [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    )
    plain = symsurf.detect_plane(
        symsurf.Shape(corners, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3))
    )
    meshio = pytest.importorskip("meshio", reason="needs meshio")
    found = symsurf.detect_plane(meshio.Mesh(corners, [("quad", quads)]))
    assert repr(found.mirror) == repr(plain.mirror) and found.score == plain.score
    itk = pytest.importorskip("itk", reason="needs ITK")
    mesh = itk.Mesh[itk.F, 3].New()
    mesh.SetPoints(itk.vector_container_from_array(corners.astype(np.float32).ravel()))
    cells = [np.array((1, 2, 0, 1))] + [
        np.array((3 + i % 2, 4, *quad)) for i, quad in enumerate(quads)
    ]
    mesh.SetCellsArray(itk.vector_container_from_array(np.concatenate(cells).astype(np.uint64)))
    found = symsurf.detect_plane(mesh)
    assert repr(found.mirror) == repr(plain.mirror) and found.score == plain.score


def test_poly_data_need_no_pyvista(shape):
    vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel", reason="needs VTK")
    pyvista = pytest.importorskip("pyvista", reason="needs PyVista")
    points, faces, _ = shape
    surface = vtk.vtkPolyData()
    surface.ShallowCopy(pyvista.PolyData.from_regular_faces(points, faces))
    result = symsurf.detect_plane(surface)
    assert type(surface) is vtk.vtkPolyData and len(result.faces) == len(faces)
    assert repr(result.mirror) == repr(symsurf.detect_plane(points, faces=faces).mirror)
    grid = vtk.vtkUnstructuredGrid()
    grid.ShallowCopy(pyvista.PolyData.from_regular_faces(points, faces).cast_to_unstructured_grid())
    assert repr(symsurf.detect_plane(grid).mirror) == repr(result.mirror)
