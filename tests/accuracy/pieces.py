"""Closed triangle meshes of simple pieces: boxes, tubes, plates, wings, gears."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .poses import Points

Mesh = tuple[Points, NDArray[np.int64]]
"""Vertices (n, 3) and triangles (m, 3)."""


def loft(rings: ArrayLike) -> Mesh:
    """The closed mesh through rings (m, k, 3) of points, capped at both ends. Four triangles meet
    in the middle of every quadrilateral, so rings and images of them give a mesh and its image."""
    rings = np.asarray(rings, dtype=float)
    count, sides, _ = rings.shape
    corner = np.arange(count * sides).reshape(count, sides)
    quads = np.stack(
        [corner[:-1], np.roll(corner, -1, 1)[:-1], np.roll(corner, -1, 1)[1:], corner[1:]], axis=-1
    ).reshape(-1, 4)
    vertices = rings.reshape(-1, 3)
    middles = vertices[quads].mean(axis=1)
    hubs = rings[[0, -1]].mean(axis=1)
    apex = len(vertices) + np.arange(len(quads))
    first_hub = len(vertices) + len(quads)
    faces = [np.column_stack([quads[:, k], quads[:, (k + 1) % 4], apex]) for k in range(4)]
    for hub, ring in ((first_hub, corner[0, ::-1]), (first_hub + 1, corner[-1])):
        faces.append(np.column_stack([ring, np.roll(ring, -1), np.full(sides, hub)]))
    return _outward(np.vstack([vertices, middles, hubs]), np.vstack(faces))


def _outward(points: Points, faces: NDArray[np.int64]) -> Mesh:
    a, b, c = (points[faces[:, k]] for k in range(3))
    volume = (a * np.cross(b, c)).sum()
    return points, faces if volume > 0 else faces[:, ::-1]


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Their triangles side by side; what lies inside of others stays."""
    starts = np.cumsum([0, *(len(points) for points, _ in meshes)])
    faces = [faces + start for (_, faces), start in zip(meshes, starts)]
    return np.vstack([points for points, _ in meshes]), np.vstack(faces)


def mirrored_in_x(mesh: Mesh) -> Mesh:
    points, faces = mesh
    return points * [-1, 1, 1], faces[:, ::-1]


def box(centre: ArrayLike, size: ArrayLike) -> Mesh:
    half = np.asarray(size, dtype=float) / 2
    ring = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half[:2]
    rings = [np.column_stack([ring, np.full(4, height)]) for height in (-half[2], half[2])]
    return loft(np.array(rings) + np.asarray(centre))


def tube(path: ArrayLike, radii: ArrayLike, sides: int = 12) -> Mesh:
    """Around a path (m, 3), straight or bent, with a radius for all or each of its points. With an
    even number of sides it is its own image in x = 0 where its path is: in that plane, or
    along x."""
    path = np.asarray(path, dtype=float)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    aside = np.where(np.abs(along[:, :1]) > 0.9, [[0.0, 1, 0]], [[1.0, 0, 0]])
    aside -= (aside * along).sum(axis=1, keepdims=True) * along
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    upward = np.cross(along, aside)
    angle = 2 * np.pi * (np.arange(sides) + 0.5) / sides
    circle = np.cos(angle)[:, None] * aside[:, None] + np.sin(angle)[:, None] * upward[:, None]
    radii = np.broadcast_to(np.asarray(radii, dtype=float), len(path))
    return loft(path[:, None] + radii[:, None, None] * circle)


def plate(low: ArrayLike, high: ArrayLike, thickness: ArrayLike, edge: float | None = None) -> Mesh:
    """Upright in x = 0, between two polylines (m, 2) of y and z. It is so thick at the lower one,
    for all or each of its points, and by the share ``edge`` of it at the higher one."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    half = np.broadcast_to(np.asarray(thickness, dtype=float), len(low)) / 2
    thinner = half * (1 if edge is None else edge)
    sides = [(-half, low), (half, low), (thinner, high), (-thinner, high)]
    return loft(np.stack([np.column_stack([x, line]) for x, line in sides], axis=1))


def wing(sections: ArrayLike) -> Mesh:
    """Through sections, each (x, y of the leading edge, chord, z, thickness)."""
    rings = []
    for x, y, chord, z, thickness in np.asarray(sections, dtype=float):
        middle, half = y + 0.35 * chord, thickness / 2
        rings.append([[x, y, z], [x, middle, z + half], [x, y + chord, z], [x, middle, z - half]])
    return loft(rings)


def gear_outline(teeth: int, depth: float, points: int = 8) -> NDArray[np.float64]:
    """(teeth * points, 2): trapezoids, from radius 1 - depth to 1; tooth and gap are each their
    own image."""
    phase = np.arange(points) / points
    rising = np.clip(1.5 - 5 * np.abs(phase - 0.5), 0, 1)
    radius = np.tile(1 - depth + depth * rising, teeth)
    angle = 2 * np.pi * np.arange(teeth * points) / (teeth * points)
    return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
