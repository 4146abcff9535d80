"""Meshes as the parts of one shape."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..shapes import Shape
from .location import require_memory

_POINT = 24  # bytes
Part = tuple[NDArray[np.float64], NDArray[np.int64]]
"""Points (n, 3) and faces (m, 3)."""


def joined(parts: Iterable[Part]) -> Shape:
    """One behind the other."""
    points = [np.empty((0, 3))]
    faces = [np.empty((0, 3), np.int64)]
    count = 0
    for own_points, own_faces in parts:
        points.append(own_points)
        faces.append(own_faces + count)
        count += len(own_points)
        require_memory(_POINT * count)
    triangles = np.concatenate(faces)
    return Shape(np.concatenate(points), triangles if len(triangles) else None)


def transformed(
    points: NDArray[np.float64], faces: NDArray[np.int64], matrix: NDArray[np.float64]
) -> Part:
    """The image over a matrix (4, 4); where that mirrors, the faces are turned round."""
    image = points @ matrix[:3, :3].T + matrix[:3, 3]
    is_mirrored = np.linalg.det(matrix[:3, :3]) < 0
    return image, faces[:, ::-1] if is_mirrored else faces


def strips(corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """The triangles of a strip, each of which shares an edge with the one before, wound alike. Those
    with a corner twice, which join strips, are left out."""
    made = np.column_stack([corners[:-2], corners[1:-1], corners[2:]])
    made[1::2] = made[1::2, [1, 0, 2]]
    a, b, c = made.T
    return made[(a != b) & (b != c) & (a != c)]
