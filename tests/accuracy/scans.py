"""A facade with a grid of windows, as a laser scanner sees it: from two stations, with noise along
the rays and with areas that something in front hides."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from .poses import Points

Array = NDArray[np.float64]
COUNT = 20_000  # points of a scan, about
NOISE = 0.001  # standard deviation along a ray, of the diagonal
HIDDEN = 3  # areas
LEAST_SEEN = 0.5  # of the points that a whole window has: a window with less is not asked for


@dataclass
class Facade:
    points: Points
    windows: Points
    """(k, 3): the middles of those that are seen."""
    diagonal: float

    def pairs(self) -> list[tuple[Points, Points]]:
        return list(combinations(self.windows, 2))


def facade(rng: np.random.Generator) -> Facade:
    """A wall with three or four rows of three to five windows, each with a frame and a sill."""
    rows, columns = rng.integers(3, 5), rng.integers(3, 6)
    wide, high = rng.uniform(1.2, 1.6), rng.uniform(1.6, 2.2)
    step = wide + rng.uniform(1.0, 1.6), high + rng.uniform(1.0, 1.6)
    frame, depth, sill = rng.uniform(0.15, 0.25), rng.uniform(0.25, 0.5), rng.uniform(0.5, 0.8)
    size = np.array([columns * step[0], rows * step[1]]) + rng.uniform(0.5, 1.5)
    boxes = [((0, 0, -0.2), (*size, 0.4))]
    middles = []
    for i in range(columns):
        for j in range(rows):
            x, y = (i - (columns - 1) / 2) * step[0], (j - (rows - 1) / 2) * step[1]
            middles.append((x, y, 0))
            boxes += [
                *(((x + s * wide / 2, y, depth / 2), (frame, high, depth)) for s in (-1, 1)),
                ((x, y + high / 2, depth / 2), (wide + frame, frame, depth)),
                ((x, y - high / 2, sill / 2), (wide + 2 * frame, frame, sill)),
                ((x, y, depth / 4), (0.6 * frame, high, depth / 2)),
            ]
    points = _scanned(np.array(boxes), size, rng)
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    windows = np.array(middles)
    half = np.array([wide, high]) / 2 + frame
    inside = [np.flatnonzero((np.abs(points[:, :2] - at[:2]) < half).all(axis=1)) for at in windows]
    seen = np.ones(len(points), bool)
    for _ in range(HIDDEN):
        at = points[rng.integers(len(points))]
        seen &= np.linalg.norm(points - at, axis=1) > rng.uniform(0.06, 0.12) * diagonal
    left = np.array([seen[rows].mean() for rows in inside])
    return Facade(points[seen], windows[left >= LEAST_SEEN], diagonal)


def _scanned(boxes: Array, size: Array, rng: np.random.Generator) -> Points:
    """What rays from two stations meet first, even over the angle."""
    points = []
    for side in (-1, 1):
        station = np.array([side * 0.3 * size[0], -0.4 * size[1], 0.9 * size.max()])
        aims = np.zeros((4 * COUNT, 3))
        aims[:, :2] = rng.uniform(-0.5, 0.5, size=(4 * COUNT, 2)) * size
        rays = aims - station
        length = np.linalg.norm(rays, axis=1)
        # Of those spread evenly over the wall, as many as are even over the angle.
        cosine = -rays[:, 2] / length
        density = cosine / length**2
        rays = (rays / length[:, None])[rng.random(len(rays)) < density / density.max()]
        hits = rays[: COUNT // 2] * _first_hit(station, rays[: COUNT // 2], boxes)[:, None]
        points.append((station + hits, rays[: COUNT // 2]))
    clean, rays = (np.vstack(each) for each in zip(*points))
    kept = np.isfinite(clean).all(axis=1)
    clean, rays = clean[kept], rays[kept]
    noise = NOISE * np.linalg.norm(np.ptp(clean, axis=0))
    return clean + rng.normal(scale=noise, size=(len(rays), 1)) * rays


def _first_hit(origin: Array, rays: Array, boxes: Array) -> Array:
    """How far along each ray the first of the boxes (k, 2, 3), middle and size, is; inf: none."""
    first = np.full(len(rays), np.inf)
    for middle, size in boxes:
        ends = (np.stack([middle - size / 2, middle + size / 2]) - origin)[:, None] / rays
        enter, leave = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
        first = np.where(enter <= leave, np.minimum(first, enter), first)
    return first
