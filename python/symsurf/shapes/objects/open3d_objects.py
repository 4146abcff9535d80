"""Open3D's clouds and triangle meshes, those of tensors and the others."""

from __future__ import annotations

from typing import Any

import numpy as np
import open3d
from numpy.typing import NDArray

from .parts import Parts, Remade


def parts_of(given: Any) -> Parts:
    if _is_tensors(given):
        points = _points_of(given)
        faces = getattr(given, "triangle", None)
        return Parts(
            _array(points.positions) if "positions" in points else np.empty((0, 3)),
            _array(faces.indices) if faces is not None and "indices" in faces else None,
            _array(points.colors) if "colors" in points else None,
        )
    if isinstance(given, open3d.geometry.PointCloud):
        colours = np.asarray(given.colors) if given.has_colors() else None
        return Parts(np.asarray(given.points), None, colours)
    colours = np.asarray(given.vertex_colors) if given.has_vertex_colors() else None
    return Parts(np.asarray(given.vertices), np.asarray(given.triangles), colours)


def remade(given: Any, made: Remade) -> Any:
    """Without normals where points have moved. Open3D's older classes have room for no arrays."""
    if _is_tensors(given):
        return _remade_tensors(given, made)
    if isinstance(given, open3d.geometry.PointCloud):
        return _remade_cloud(given, made)
    return _remade_mesh(given, made)


def _remade_cloud(given: Any, made: Remade) -> Any:
    cloud = open3d.geometry.PointCloud(_vectors(made.points))
    if given.has_colors():
        cloud.colors = _vectors(made.of_points(given.colors))
    if given.has_normals() and not made.moved:
        cloud.normals = given.normals
    return cloud


def _remade_mesh(given: Any, made: Remade) -> Any:
    faces = np.empty((0, 3)) if made.faces is None else made.faces
    corners = open3d.utility.Vector3iVector(np.ascontiguousarray(faces, np.int32))
    mesh = open3d.geometry.TriangleMesh(_vectors(made.points), corners)
    if given.has_vertex_colors():
        mesh.vertex_colors = _vectors(made.of_points(given.vertex_colors))
    if given.has_vertex_normals() and not made.moved:
        mesh.vertex_normals = given.vertex_normals
    if given.has_triangle_uvs() and not made.is_other:
        by_corner = np.asarray(given.triangle_uvs).reshape(-1, 3, 2)
        mesh.triangle_uvs = open3d.utility.Vector2dVector(_turned(by_corner, made).reshape(-1, 2))
        mesh.textures = given.textures
    if given.has_triangle_material_ids():
        numbers = made.of_faces(given.triangle_material_ids)
        mesh.triangle_material_ids = open3d.utility.IntVector(numbers)
    return mesh


def _remade_tensors(given: Any, made: Remade) -> Any:
    copy = given.clone()
    of_points = _points_of(copy)
    for name, values in list(of_points.items()):
        if name == "positions":
            of_points[name] = _tensor(made.points, values)
        elif name == "normals" and made.moved:
            del of_points[name]
        else:
            of_points[name] = _tensor(made.of_points(_array(values), name), values)
    for name, array in made.arrays.items():
        of_points[name] = open3d.core.Tensor(np.ascontiguousarray(array), device=given.device)
    if hasattr(copy, "triangle"):
        _set_triangles(copy, given, made)
    return copy


def _set_triangles(copy: Any, given: Any, made: Remade) -> None:
    of_faces = copy.triangle
    for name, values in list(given.triangle.items()):
        if name == "indices":
            faces = np.empty((0, 3), np.int64) if made.faces is None else made.faces
            of_faces[name] = _tensor(faces, values)
        elif (name == "normals" and made.moved) or (name == "texture_uvs" and made.is_other):
            del of_faces[name]
        else:
            own = made.of_faces(_array(values))
            own = _turned(own, made) if name == "texture_uvs" else own
            of_faces[name] = _tensor(own, values)
    for name, array in made.face_arrays.items():
        of_faces[name] = open3d.core.Tensor(np.ascontiguousarray(array), device=given.device)


def _is_tensors(given: Any) -> bool:
    return hasattr(given, "to_legacy")


def _points_of(given: Any) -> Any:
    """The tensors of the points, by name."""
    return given.vertex if hasattr(given, "vertex") else given.point


def _array(tensor: Any) -> NDArray[Any]:
    return tensor.cpu().numpy()


def _tensor(values: NDArray[Any], like: Any) -> Any:
    return open3d.core.Tensor(np.ascontiguousarray(values), dtype=like.dtype, device=like.device)


def _vectors(values: NDArray[Any]) -> Any:
    return open3d.utility.Vector3dVector(np.ascontiguousarray(values, np.float64))


def _turned(by_corner: NDArray[Any], made: Remade) -> NDArray[Any]:
    """What the corners (m, 3, ...) of faces have, of faces that may be turned."""
    return by_corner[:, [0, 2, 1]] if made.turned else by_corner
