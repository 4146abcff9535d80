"""Meshes as the parts of one shape."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..shapes import Shape
from .location import require_memory

_ROW = 24  # bytes of a point, and of a triangle
_MOST_PARTS = 100_000  # each may be made of two that are made of two, and so on


class Part(NamedTuple):
    """A mesh where its matrix puts it, which is made when it is needed: few bytes may name it often."""

    points: int
    faces: int
    """As many as it has, or fewer."""
    make: Callable[[], tuple[NDArray[Any], NDArray[np.int64]]]
    """Its points (n, 3) and faces (m, 3)."""
    matrix: NDArray[np.float64]
    """(4, 4)"""


def joined(parts: Iterable[Part], file_size: int) -> Shape:
    """One behind the other. Raises InvalidInput, before any is made, where they are too many, or take
    far more memory than a file of that many bytes stands for."""
    counted: list[Part] = []
    points = faces = 0
    for part in parts:
        counted.append(part)
        points, faces = points + part.points, faces + part.faces
        require_memory(_ROW * (points + faces), file_size)
        require_parts(len(counted))
    whole, triangles = np.empty((points, 3)), np.empty((faces, 3), np.int64)
    points = faces = 0
    for part in counted:
        own, corners = part.make()
        whole[points : points + len(own)] = own @ part.matrix[:3, :3].T + part.matrix[:3, 3]
        is_mirrored = np.linalg.det(part.matrix[:3, :3]) < 0
        triangles[faces : faces + len(corners)] = corners[:, ::-1] if is_mirrored else corners
        triangles[faces : faces + len(corners)] += points
        points, faces = points + len(own), faces + len(corners)
    return Shape(whole, triangles[:faces] if faces else None)


def require_parts(count: int) -> None:
    if count > _MOST_PARTS:
        raise InvalidInput(f"it has more than {_MOST_PARTS} parts, which are the most allowed")


def strips(corners: NDArray[np.int64]) -> NDArray[np.int64]:
    """The triangles of a strip, each of which shares an edge with the one before, wound alike. Those
    with a corner twice, which join strips, are left out."""
    made = np.column_stack([corners[:-2], corners[1:-1], corners[2:]])
    made[1::2] = made[1::2, [1, 0, 2]]
    a, b, c = made.T
    return made[(a != b) & (b != c) & (a != c)]
