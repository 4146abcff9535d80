"""Points on both sides of the surfaces f1 to f6, at random places, and their true mirror."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symsurf import Mirror, make_mirror
from symsurf.synthetic import surface

from .poses import Points, random_rotation, turned

SIZES = (500, 1000, 2000, 5000)
REACH = {"f1": 2.0, "f2": 1.5, "f3": 2.0, "f4": 2.0, "f5": 2.0, "f6": 0.9}
"""How far x and y go from 0; f6 is defined on the unit disc only."""


@dataclass(frozen=True)
class Sheets:
    points: Points
    truth: Mirror
    pairs: NDArray[np.int64]
    """Rows of a point and of its image; none where the sides were drawn independently."""

    def turned(self, rotation: NDArray[np.float64]) -> Sheets:
        return Sheets(self.points @ rotation.T, turned(self.truth, rotation), self.pairs)


def known_surface(name: str, mapping: str) -> Mirror:
    numbers = {"surface": name, "mapping": mapping, "scale": 1.0}
    return make_mirror("surface", numbers | {"rotation": np.eye(3), "translation": np.zeros(3)})


def random_places(name: str, count: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """(count, 2) over the square, or the disc, where the surface is defined."""
    places = rng.uniform(-1, 1, size=(4 * count, 2))
    if name == "f6":
        places = places[np.linalg.norm(places, axis=1) < 1]
    return REACH[name] * places[:count]


def perpendicular_sheets(
    name: str, near: float, far: float, waves: int, exact: bool, rng: np.random.Generator
) -> Sheets:
    """Both sides of a surface, in ``waves`` legs from ``near`` to ``far`` and back along x."""
    count = int(rng.choice(SIZES)) // 2

    def side(places: NDArray[np.float64], sign: int) -> Points:
        x, y = places.T
        f = surface(name)
        slope_x, slope_y = f.gradient(x, y)
        normal = np.column_stack([-slope_x, -slope_y, np.ones_like(x)])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        distance = _waving(x / REACH[name], near, far, waves)
        return np.column_stack([x, y, f(x, y)]) + sign * distance[:, None] * normal

    places = random_places(name, count, rng)
    others = places if exact else random_places(name, count, rng)
    points = np.vstack([side(places, 1), side(others, -1)])
    return _posed(points, known_surface(name, "perpendicular"), count, exact, rng)


OFFSETS = {"near": (0.15, 0.4), "far": (0.9, 1.4)}
"""Distances along z from the mirror, in units of the reach."""
BODIES = {
    "closed": lambda x, y: np.sqrt(np.maximum(0, 1 - x**2 - y**2)) * (1 + 0.3 * np.sin(4 * x + y)),
    "torus": lambda x, y: _torus_height(x, y),
}
"""The same over x and y in units of the reach, of closed shapes; NaN: no point."""


def _torus_height(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    # Upright about the x axis: a line along z meets it up to four times.
    ring, tube = 0.7, 0.28
    inside = np.sqrt(np.maximum(tube**2 - x**2, 0)) * np.where(np.arange(len(x)) % 2, 1, -1)
    squared = (ring + inside) ** 2 - y**2
    return np.where((np.abs(x) < tube) & (squared > 0), np.sqrt(np.maximum(squared, 0)), np.nan)


def fixed_sheets(
    name: str, near: float, far: float, waves: int, exact: bool, rng: np.random.Generator
) -> Sheets:
    """Both sides of a surface along z, at ``near`` to ``far`` times its reach from it."""
    count = int(rng.choice(SIZES)) // 2

    def heights(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
        return _waving(x, near, far, waves)

    return _along_z(name, heights, count, exact, rng)


def fixed_body(name: str, body: str, exact: bool, rng: np.random.Generator) -> Sheets:
    """A closed shape that a surface halves along z."""
    return _along_z(name, BODIES[body], int(rng.choice(SIZES)) // 2, exact, rng)


def _along_z(
    name: str, heights: Callable, count: int, exact: bool, rng: np.random.Generator
) -> Sheets:
    def side(sign: int) -> Points:
        places = random_places(name, 40 * count, rng)
        x, y = places.T
        distance = REACH[name] * heights(x / REACH[name], y / REACH[name])
        kept = np.isfinite(distance) & (distance > 0)
        x, y, distance = (a[kept][:count] for a in (x, y, distance))
        return np.column_stack([x, y, surface(name)(x, y) + sign * distance])

    truth = known_surface(name, "fixed")
    upper = side(1)
    points = np.vstack([upper, truth.reflect(upper) if exact else side(-1)])
    return _posed(points, truth, len(upper), exact, rng)


def _waving(x: NDArray[np.float64], near: float, far: float, waves: int) -> NDArray[np.float64]:
    """Distances in that many legs from ``near`` to ``far`` and back, for x from -1 to 1."""
    leg = (x + 1) / 2 * waves
    return near + (far - near) * (1 - np.abs(1 - leg % 2) if waves else np.zeros_like(x))


def _posed(
    points: Points, truth: Mirror, count: int, exact: bool, rng: np.random.Generator
) -> Sheets:
    rows = np.arange(count)
    pairs = np.column_stack([rows, rows + count]) if exact else np.empty((0, 2), dtype=np.int64)
    return Sheets(points, truth, pairs).turned(random_rotation(rng))
