"""The images of whole meshes over a mirror."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import Mirror
from .shapes import Shape


def reflected(mesh: Any, mirror: Mirror) -> Any:
    """The image of a mesh, with its faces turned round; see ``Mirror.reflect``."""
    if isinstance(mesh, Shape):
        faces = None if mesh.faces is None else _turned(mesh.faces)
        return Shape(mirror.reflect(np.asarray(mesh.points)), faces)
    pyvista = sys.modules.get("pyvista")  # imported where there is a data set
    if pyvista is not None and isinstance(mesh, pyvista.DataSet):
        from .shapes import grids

        return grids.turned_inside_out(mesh, mirror.reflect(np.asarray(mesh.points, dtype=float)))
    trimesh = sys.modules.get("trimesh")
    if trimesh is not None and isinstance(mesh, trimesh.Trimesh):
        image = mesh.copy()
        image.vertices = mirror.reflect(np.asarray(mesh.vertices))
        image.faces = _turned(np.asarray(mesh.faces))
        return image
    return mirror.reflect(np.asarray(mesh.points if hasattr(mesh, "points") else mesh.vertices))


def _turned(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.ascontiguousarray(faces[:, [0, 2, 1]])
