"""Meshes of parts whose symmetries are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from .solids import sampled

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """Triangles, with the main axis or the normal of the only mirror along z."""

    group: str
    triangles: Array
    """(m, 3, 3) corners."""
    planes: int
    """How many ``symsurf.symmetries`` is to list."""
    axes: Sequence[int]
    """The orders of the axes, as they are to be listed."""

    def sampled(self, count: int, rng: np.random.Generator) -> Array:
        """Points drawn evenly over the surface."""
        corners = self.triangles.reshape(-1, 3)
        return sampled(corners, np.arange(len(corners)).reshape(-1, 3), count, rng)


def extruded(outline: Array, height: float, middle: Array | None = None) -> Array:
    """A prism over an outline that can be seen whole from its middle."""
    inside = np.zeros(2) if middle is None else middle
    after = np.roll(outline, -1, axis=0)
    triangles = []
    for (x, y), (u, v) in zip(outline, after, strict=True):
        low, high = -height / 2, height / 2
        triangles += [
            [(x, y, low), (u, v, low), (u, v, high)],
            [(x, y, low), (u, v, high), (x, y, high)],
            [(*inside, high), (x, y, high), (u, v, high)],
            [(*inside, low), (x, y, low), (u, v, low)],
        ]
    return np.array(triangles)


def ring(outer: Array, inner: Array, height: float) -> Array:
    """A prism with a hole, between two outlines of as many points."""
    low, high = -height / 2, height / 2
    triangles = []
    for k in range(len(outer)):
        n = (k + 1) % len(outer)
        for one in (outer, inner):
            a, b = one[k], one[n]
            triangles += [[(*a, low), (*b, low), (*b, high)], [(*a, low), (*b, high), (*a, high)]]
        for z in (low, high):
            a, b, c, d = outer[k], outer[n], inner[n], inner[k]
            triangles += [[(*a, z), (*b, z), (*c, z)], [(*a, z), (*c, z), (*d, z)]]
    return np.array(triangles)


def polygon(corners: int, radius: float = 1.0) -> Array:
    angle = 2 * np.pi * np.arange(corners) / corners
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def turned(radius: Sequence[float], height: Sequence[float], steps: int = 180) -> Array:
    """A surface of revolution through the given circles."""
    angle = 2 * np.pi * np.arange(steps + 1) / steps
    circles = np.array(
        [
            np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(steps + 1, z)])
            for r, z in zip(radius, height, strict=True)
        ]
    )
    a, b, c, d = circles[:-1, :-1], circles[:-1, 1:], circles[1:, 1:], circles[1:, :-1]
    return np.concatenate(
        [np.stack(three, axis=2).reshape(-1, 3, 3) for three in ((a, b, c), (a, c, d))]
    )


def gear(teeth: int, slant: float = 0.0) -> Array:
    """Teeth with flanks that lean the more to one side the larger the slant, around a hole."""
    root, tip = 0.82, 1.0
    shares = np.array([0.0, 0.3, 0.5 + slant, 0.8 + slant])  # of a tooth's pitch
    radii = np.array([root, root, tip, tip])
    angle = 2 * np.pi * (np.arange(teeth)[:, None] + shares).ravel() / teeth
    radius = np.tile(radii, teeth)
    outer = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return ring(outer, 0.35 * outer / radius[:, None], 0.3)


def box(x: float, y: float, z: float) -> Array:
    corners = np.array(list(product((-0.5, 0.5), repeat=3))) * (x, y, z)
    sides = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    return corners[[three for a, b, c, d in sides for three in ((a, b, c), (a, c, d))]]


def propeller(blades: int) -> Array:
    """Blades set at an angle, around a hub that is longer on one side."""
    blade = box(0.9, 0.3, 0.06) @ rotation_about((1, 0, 0), 0.5).T + (0.6, 0, 0)
    hub = turned([0, 0.2, 0.2, 0], [-0.35, -0.35, 0.2, 0.2])
    turns = [rotation_about((0, 0, 1), 2 * np.pi * k / blades) for k in range(blades)]
    return np.concatenate([hub, *(blade @ turn.T for turn in turns)])


def bottle() -> Array:
    body = turned([0, 0.5, 0.5, 0.2, 0.2], [-1, -1, 0.3, 0.7, 1])
    handle = box(0.25, 0.1, 0.8) + (0.65, 0, -0.3)
    return np.concatenate([body, handle]) @ rotation_about((1, 0, 0), np.pi / 2).T


def tetrahedron() -> Array:
    corners = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], float)
    return corners[[(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)]]


def lump() -> Array:
    """Nothing maps it onto itself."""
    return np.concatenate(
        [
            box(2, 1.2, 0.6),
            box(0.5, 0.6, 0.9) + (-0.6, 0.25, 0.7),
            box(0.7, 0.4, 0.5) + (0.5, -0.35, 0.5),
            box(0.3, 0.9, 0.3) + (1.1, 0.6, -0.1),
        ]
    )


def sphere() -> Array:
    angle = np.linspace(0, np.pi, 91)
    return turned(np.sin(angle).tolist(), np.cos(angle).tolist())


def rotation_about(axis: Sequence[float], angle: float) -> Array:
    """By Rodrigues' formula."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([(0, -z, y), (z, 0, -x), (-y, x, 0)])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


_BRACKET = np.array([(0, 0), (2, 0), (2, 0.4), (0.4, 0.4), (0.4, 1.3), (0, 1.3)])

PARTS = {
    "hexagonal nut": Part("D6h", ring(polygon(6), 0.55 * polygon(6), 0.8), 7, [6] + 6 * [2]),
    "gear of 7": Part("D7h", gear(7), 8, [7] + 7 * [2]),
    "gear of 24": Part("D24h", gear(24), 25, [24] + 24 * [2]),
    "slanted gear": Part("C9h", gear(9, slant=0.15), 1, [9]),
    "propeller": Part("C3", propeller(3), 0, [3]),
    "box": Part("D2h", box(2, 1.4, 0.9), 3, [2, 2, 2]),
    "cube": Part("Oh", box(1, 1, 1), 9, 3 * [4] + 4 * [3] + 6 * [2]),
    "tetrahedron": Part("Td", tetrahedron(), 6, 4 * [3] + 3 * [2]),
    "prism": Part("D3h", extruded(polygon(3), 1.6), 4, [3, 2, 2, 2]),
    "bracket": Part("Cs", extruded(_BRACKET, 0.8, np.array((0.2, 0.2))), 1, []),
    "cylinder": Part("D∞h", turned([0, 0.5, 0.5, 0], [-0.8, -0.8, 0.8, 0.8]), 2, [0, 2]),
    "cone": Part("C∞v", turned([0, 0.8, 0], [0, 0, 1.6]), 1, [0]),
    "sphere": Part("K", sphere(), 0, [0, 0, 0]),
    "bottle with a handle": Part("Cs", bottle(), 1, []),
    "asymmetric part": Part("C1", lump(), 0, []),
}


def cut(points: Array, share: float, rng: np.random.Generator) -> Array:
    """The points without three unlike balls, which hold that share of them."""
    left = np.ones(len(points), bool)
    for part in (0.5, 0.3, 0.2):
        middle = points[rng.choice(np.flatnonzero(left))]
        distance = np.where(left, np.linalg.norm(points - middle, axis=1), np.inf)
        left[np.argsort(distance)[: round(part * share * len(points))]] = False
    return points[left]


def noisy(points: Array, share: float, rng: np.random.Generator) -> Array:
    """Normal noise with a standard deviation that is a share of the diagonal."""
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    return points + rng.normal(scale=share * diagonal, size=points.shape)
