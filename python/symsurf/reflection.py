"""The images of whole meshes over a mirror."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import AttributeTransform, Mirror
from .shapes import Shape, objects
from .shapes.kinds import UNDIRECTED, Carry, carried_by


def carry_over(mirror: Mirror, points: NDArray[np.float64]) -> Carry:
    """What takes values of points (n, 3) to their images."""
    by, rows = AttributeTransform(mirror, points), np.arange(len(points))[:, None]

    def carried(values: NDArray[Any], kind: str, name: object) -> NDArray[Any]:
        if kind in UNDIRECTED:
            return values
        return carried_by(by, values, kind, lambda p, _: mirror.reflect(p), rows, name=name)

    return carried


def reflected(mesh: Any, mirror: Mirror) -> Any:
    """The image of a mesh, with its faces turned round; see ``Mirror.reflect``."""
    if isinstance(mesh, Shape):
        faces = None if mesh.faces is None else _turned(mesh.faces)
        return Shape(mirror.reflect(np.asarray(mesh.points)), faces)
    parts = objects.parts_of(mesh)
    if parts is None:
        return mirror.reflect(np.asarray(objects.points_of(mesh)))
    points = np.asarray(parts.points, dtype=float)
    images = mirror.reflect(points)
    faces = None if parts.faces is None else _turned(np.asarray(parts.faces))
    carried = carry_over(mirror, points)
    made = objects.Remade(images, faces, turned=True, carried=carried, turns=True)
    return objects.remade(mesh, made)


def _turned(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.ascontiguousarray(faces[:, [0, 2, 1]])
