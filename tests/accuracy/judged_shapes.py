"""Random bodies with one known plane of symmetry, straight or bent, and what damages one side."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import Mirror, Plane, Sphere

from .bodies import STEEPEST
from .cad import KINDS, cad_mesh
from .icp import best_plane
from .nearly_symmetric import shape_of
from .pieces import Mesh, box, loft
from .poses import Points, diagonal, random_rotation, turned
from .solids import bent, bumps, lacking, mirrored_mesh, sampled
from .symmetric_parts import turned as revolved

Rng = np.random.Generator
Rows = NDArray[np.bool_]

SCANNED = ("ant", "airplane", "cow", "face", "skull")
THIN = ("plate", "pot", "shell")
SYMMETRIC = (*SCANNED, "CAD", "blob", *THIN)
ONE_PLANE = ("ant", "airplane", "cow", "face", "blob", "chair", "aircraft", "rifle")
"""Bodies without a second plane, which a bend of the first would leave exact."""


def symmetric(subject: str, rng: Rng) -> tuple[Points, NDArray[np.int64], Plane]:
    """Vertices, faces and the plane of a body in a random pose; a CAD kind may be named too."""
    vertices, faces, plane = _standing(subject, rng)
    return in_pose(vertices, faces, plane, rng)


def one_of(subjects: tuple[str, ...], rng: Rng) -> str:
    """Any whose files are there."""
    return str(rng.choice([subject for subject in subjects if not lacking(subject)]))


def in_pose(
    vertices: Points, faces: NDArray[np.int64], plane: Plane, rng: Rng
) -> tuple[Points, NDArray[np.int64], Plane]:
    rotation = random_rotation(rng)
    posed = turned(plane, rotation)
    assert isinstance(posed, Plane)
    return vertices @ rotation.T, faces, posed


def _standing(subject: str, rng: Rng) -> tuple[Points, NDArray[np.int64], Plane]:
    if subject == "skull":
        vertices, faces, marks, partners = shape_of(subject, rng)
        return vertices, faces, best_plane(marks, partners)
    if subject in SCANNED:
        return mirrored_mesh(subject)
    makers = {"blob": _blob, "plate": _plate, "pot": _pot, "shell": _shell}
    if subject in makers:
        mesh = makers[subject](rng)
    else:
        mesh = cad_mesh(str(rng.choice(list(KINDS))) if subject == "CAD" else subject, rng)
    return *mesh, Plane((1, 0, 0), 0.0)


def _blob(rng: Rng, rings: int = 49, sides: int = 96) -> Mesh:
    """A bumpy ball, the same on both sides of x = 0."""
    polar = np.linspace(0.02, np.pi - 0.02, rings)[:, None]
    angle = 2 * np.pi * (np.arange(sides) + 0.5) / sides
    x, y = np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle)
    ways = np.stack([x, y, np.broadcast_to(np.cos(polar), x.shape)], axis=-1).reshape(-1, 3)
    folded = np.column_stack([ways[:, 0] ** 2, ways[:, 1:]])
    radii = bumps(folded, rng)
    return loft((ways * radii[:, None] * rng.uniform((0.7, 0.5, 0.5), 1)).reshape(rings, sides, 3))


def _plate(rng: Rng) -> Mesh:
    """About 200 x 300 and 2 to 40 thick; its plane crosses the width, the length or the thickness."""
    size = np.array([rng.uniform(100, 250), rng.uniform(250, 400), rng.uniform(2, 40)])
    return box((0, 0, 0), np.roll(size, rng.integers(3)))


def _revolved(radii: NDArray[np.float64], heights: NDArray[np.float64]) -> Mesh:
    corners = revolved(radii.tolist(), heights.tolist()).reshape(-1, 3)
    return corners, np.arange(len(corners)).reshape(-1, 3)


def _pot(rng: Rng) -> Mesh:
    """Upright, with a wall of 2 to 60 over a diagonal of about 340."""
    radius, height = rng.uniform(70, 110), rng.uniform(120, 240)
    wall = np.exp(rng.uniform(np.log(2), np.log(60)))
    inner = radius - wall
    outline = [(0, 0), (radius, 0), (radius, height), (inner, height), (inner, wall), (0, wall)]
    return _revolved(*np.array(outline, dtype=float).T)


def _shell(rng: Rng) -> Mesh:
    """An oval bowl, 1 to 8 % as thick as it is wide."""
    angle = np.linspace(0, rng.uniform(0.3, 0.7) * np.pi, 24)
    outer = np.column_stack([np.sin(angle), -np.cos(angle)])
    profile = np.vstack([outer, (1 - rng.uniform(0.02, 0.16)) * outer[::-1]])
    profile[[0, -1], 0] = 0
    points, faces = _revolved(*profile.T)
    return points * [1, rng.uniform(0.5, 1), rng.uniform(0.5, 1)], faces


def one_side_denser(subject: str, ratio: float, count: int, rng: Rng) -> tuple[Points, Plane]:
    """About so many points, on a side at random ``ratio`` times as dense as on the other."""
    vertices, faces, plane = symmetric(subject, rng)
    points = sampled(vertices, faces, round(2 * count * ratio / (ratio + 1)), rng)
    sparse = plane.signed_distance(points) * rng.choice([-1, 1]) < 0
    return points[~sparse | (rng.random(len(points)) < 1 / ratio)], plane


class Cut:
    """A share of one side's points cut off by a plane of a random direction."""

    def __init__(self, points: Points, plane: Plane, rng: Rng) -> None:
        self.points, self.plane = points, plane
        self.sign, self.way = rng.choice([-1, 1]), rng.normal(size=3)

    def lost(self, points: Points, limit: float) -> Rows:
        return (self.plane.signed_distance(points) * self.sign > 0) & (points @ self.way > limit)

    def kept(self, share: float) -> tuple[Rows, float]:
        """Which points are left, and the share of them whose image is on what is left."""
        side = self.plane.signed_distance(self.points) * self.sign > 0
        limit = float(np.quantile(self.points[side] @ self.way, 1 - share))
        left = ~self.lost(self.points, limit)
        images = self.plane.reflect(self.points[left])
        return left, float(1 - self.lost(images, limit).mean())


def arched(points: Points, plane: Plane, kind: str, sag: float) -> tuple[Points, Mirror]:
    """Points about a plane that was bent into a cylinder or sphere, and that mirror. In the middle it
    is a share ``sag`` of the diagonal above its rims, less where points reach too far from it."""
    ways = np.linalg.svd(plane.normal[None])[2][1:]
    height = plane.signed_distance(points)[:, None]
    rise, least = sag * diagonal(points), float(np.abs(height).max()) / STEEPEST
    if kind == "cylinder":
        reach = max(np.ptp(points @ way) for way in ways) / 2
        return bent(points, plane, max(least, _radius(reach, rise)) / (2 * reach))
    u, v = (points @ way for way in ways)
    across = np.column_stack([u - (u.max() + u.min()) / 2, v - (v.max() + v.min()) / 2])
    out = np.linalg.norm(across, axis=1)
    radius = max(least, _radius(out.max(), rise))
    sine_over_out = np.sinc(out / radius / np.pi) / radius
    normal = np.column_stack([across * sine_over_out[:, None], np.cos(out / radius)])
    return (radius + height) * normal, Sphere((0, 0, 0), radius)


def _radius(reach: float, rise: float) -> float:
    """Of an arc that is so high over its ends, ``reach`` from its middle along it; to the first order
    of their ratio."""
    return reach**2 / (2 * rise)


def turned_about(points: Points, mirror: Mirror, rng: Rng) -> tuple[Points, Points]:
    """Points and their images in one random pose."""
    rotation = random_rotation(rng)
    return points @ rotation.T, mirror.reflect(points) @ rotation.T


def matched(points: Points, plane: Mirror) -> float:
    return symsurf.match(points, plane, threads=1).score
