"""Shapes whose plane of symmetry is known."""

from __future__ import annotations

import numpy as np
import pymeshlab


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


class Shape:
    """A shape with one known plane of symmetry: normal . x + offset = 0."""

    def __init__(self, points: np.ndarray, faces: np.ndarray | None, seed: int):
        rng = np.random.default_rng(seed)
        rotation, shift = random_rotation(rng), rng.normal(size=3)
        self.points = points @ rotation.T + shift
        self.faces = faces
        self.normal = rotation[:, 0]
        self.offset = -float(self.normal @ shift)
        self.diagonal = float(np.linalg.norm(np.ptp(self.points, axis=0)))

    def mesh_set(self) -> pymeshlab.MeshSet:
        mesh_set = pymeshlab.MeshSet()
        faces = {} if self.faces is None else {"face_matrix": self.faces}
        mesh_set.add_mesh(pymeshlab.Mesh(vertex_matrix=self.points, **faces), "shape")
        return mesh_set


def cloud(seed: int = 0, size: int = 160) -> Shape:
    """A lump without faces, mirrored in x, its points in no order."""
    rng = np.random.default_rng(seed)
    half = rng.normal(size=(size // 2, 3)) * (1, 2, 3)
    half[:, 2] += 0.4 * half[:, 1] ** 2
    points = np.vstack([half, half * (-1, 1, 1)])
    return Shape(rng.permutation(points), None, seed)


def mesh(seed: int = 0, around: int = 24, across: int = 10) -> Shape:
    """A ring that swells to one side: its middle plane is its one plane of symmetry."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * (v + 0.5) / across
    tube = 0.5 + 0.2 * np.cos(a) + 0.1 * np.sin(2 * a) + 0.05 * np.cos(3 * a)
    radius = 2 + tube * np.cos(b)
    points = np.stack([tube * np.sin(b), radius * np.cos(a), radius * np.sin(a)], axis=-1)
    right, up = (u + 1) % around, (v + 1) % across
    corner = [np.ravel(i * across + j) for i, j in ((u, v), (right, v), (right, up), (u, up))]
    faces = np.vstack([np.stack(corner[:3], 1), np.stack([corner[0], *corner[2:]], 1)])
    return Shape(points.reshape(-1, 3), faces, seed)


def lump(seed: int = 0, around: int = 64, up: int = 32) -> Shape:
    """A dented ball, its left and right mirror images of each other."""
    u, v = np.meshgrid(np.arange(around), np.arange(up), indexing="ij")
    a, b = 2 * np.pi * u / around, np.pi * (v + 0.5) / up
    ball = np.stack([np.cos(a) * np.sin(b), np.sin(a) * np.sin(b), np.cos(b)], -1).reshape(-1, 3)
    _, y, z = ball.T
    points = ball * (1 + 0.3 * np.sin(2 * y + z) + 0.25 * y * z**2)[:, None] * (1, 1.3, 1.7)
    right, above = (u + 1) % around, v + 1
    corners = ((u, v), (u, above), (right, above), (right, v))
    corner = [np.ravel((i * up + j)[:, :-1]) for i, j in corners]
    faces = np.vstack([np.stack(corner[:3], 1), np.stack([corner[0], *corner[2:]], 1)])
    return Shape(points, faces, seed)


def lump_cloud(seed: int = 0) -> Shape:
    """The vertices of the lump in no order."""
    shape = lump(seed)
    shape.points, shape.faces = np.random.default_rng(seed).permutation(shape.points), None
    return shape


def box(seed: int) -> Shape:
    """A box of three lengths, with a plane of symmetry along each: the first is the shape's."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-2, 2) for z in (-3, 3)], float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in sides for face in ((a, b, c), (a, c, d))]
    return Shape(corners, np.array(faces), seed)


SHAPES = {"cloud": cloud, "mesh": mesh}
SURFACES = {"cloud": lump_cloud, "mesh": lump}
