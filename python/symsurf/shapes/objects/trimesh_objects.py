"""trimesh's meshes, clouds and scenes."""

from __future__ import annotations

from typing import Any

import numpy as np
import trimesh

from .parts import Parts, Remade


def parts_of(given: Any) -> Parts:
    """Of a scene all that it holds, in its place."""
    given = _geometry(given)
    if isinstance(given, trimesh.PointCloud):
        return Parts(given.vertices, None, given.colors if len(given.colors) else None)
    colours = given.visual.vertex_colors if given.visual.kind == "vertex" else None
    return Parts(given.vertices, given.faces, colours)


def remade(given: Any, made: Remade) -> Any:
    """A mesh, or a cloud where there are no faces."""
    given = _geometry(given)
    if isinstance(given, trimesh.PointCloud):
        colours = made.of_points(given.colors) if len(given.colors) else None
        return trimesh.PointCloud(made.points, colours, metadata=dict(given.metadata))
    faces = np.empty((0, 3), np.int64) if made.faces is None else made.faces
    mesh = trimesh.Trimesh(made.points, faces, process=False, metadata=dict(given.metadata))
    mesh.visual = _visual(given.visual, mesh, made)
    for name, values in given.vertex_attributes.items():
        mesh.vertex_attributes[name] = made.of_points(values, name)
    for name, values in given.face_attributes.items():
        mesh.face_attributes[name] = made.of_faces(values)
    mesh.vertex_attributes.update(made.arrays)
    mesh.face_attributes.update(made.face_arrays)
    return mesh


def _visual(given: Any, mesh: Any, made: Remade) -> Any:
    """Colours of points or faces, or a texture, for the new mesh."""
    if given.kind == "texture" and given.uv is not None:
        uv = np.asarray(given.uv)
        uv = uv if made.keeps_texture else made.of_points(uv)
        return trimesh.visual.TextureVisuals(uv=uv, material=given.material)
    colours: dict[str, Any] = {}
    if given.kind == "vertex":
        colours["vertex_colors"] = made.of_points(given.vertex_colors)
    if given.kind == "face":
        colours["face_colors"] = made.of_faces(given.face_colors)
    return trimesh.visual.ColorVisuals(mesh, **colours)


def _geometry(given: Any) -> Any:
    return given.to_geometry() if isinstance(given, trimesh.Scene) else given
