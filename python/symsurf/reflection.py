"""The images of whole meshes over a mirror."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import Mirror
from .shapes import Shape, objects


def reflected(mesh: Any, mirror: Mirror) -> Any:
    """The image of a mesh, with its faces turned round; see ``Mirror.reflect``."""
    if isinstance(mesh, Shape):
        faces = None if mesh.faces is None else _turned(mesh.faces)
        return Shape(mirror.reflect(np.asarray(mesh.points)), faces)
    parts = objects.parts_of(mesh)
    if parts is None:
        return mirror.reflect(np.asarray(objects.points_of(mesh)))
    images = mirror.reflect(np.asarray(parts.points))
    faces = None if parts.faces is None else _turned(np.asarray(parts.faces))
    return objects.remade(mesh, objects.Remade(images, faces, turned=True))


def _turned(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.ascontiguousarray(faces[:, [0, 2, 1]])
