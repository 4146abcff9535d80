"""The thesis's algorithms as they are printed: loops and sums over all pairs, nothing clever.

What the text leaves open is read as the methods' documentation says: planes through the mean of the
points, X1 strictly above, equal scores and equal distances to the first (the methods: by position).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Separated(NamedTuple):
    pairs: NDArray[np.int64]
    direction: Array
    error: float
    clearance: float
    score: float


def directions() -> Iterator[Array]:
    """Chapter 4: phi and theta in steps of a tenth of pi from 0 below pi, the pole once."""
    for i in range(10):
        for j in range(10 if i else 1):
            phi, theta = i * np.pi / 10, j * np.pi / 10
            yield np.array([np.sin(phi) * np.cos(theta), np.sin(phi) * np.sin(theta), np.cos(phi)])


def squared_from_line(points: Array, start: Array, direction: Array) -> Array:
    w = points - start
    return ((w - np.outer(w @ direction, direction)) ** 2).sum(axis=1)


def neighbours(points: Array, i: int, count: int = 10) -> Array:
    distance = ((points - points[i]) ** 2).sum(axis=1)
    return points[np.argsort(distance, kind="stable")[:count]]


def pca_normals(points: Array) -> Array:
    normals = []
    for i in range(len(points)):
        near = neighbours(points, i)
        normals.append(np.linalg.svd(near - near.mean(axis=0))[2][2])
    return np.array(normals)


def regression_normals(points: Array) -> Array:
    normals = []
    for i in range(len(points)):
        near = neighbours(points, i)
        near = near - near.mean(axis=0)
        slope = np.linalg.pinv(near[:, :2]) @ near[:, 2]
        normal = np.array([-slope[0], -slope[1], 1])
        normals.append(normal / np.linalg.norm(normal))
    return np.array(normals)


def separation(points: Array) -> Separated:
    """Algorithm 1."""

    def error(upper: Array, lower: Array, partner: Array, squared: Array) -> float:
        return float(squared.mean())

    return _best(points, error)


def separation_normals(points: Array, normals: Array, as_lines: bool) -> Separated:
    """Algorithm 2."""

    def error(upper: Array, lower: Array, partner: Array, squared: Array) -> float:
        # Term by term, so that equal normals have equal cosines; next to 1 is rounding.
        x, y, z = (np.outer(normals[upper, k], normals[lower, k]) for k in range(3))
        cosine = np.abs(x + y + z) if as_lines else x + y + z
        q = lower[np.argmax(np.where(cosine > 1 - 1e-15, 1, cosine), axis=1)]
        return float(((points[partner] - points[q]) ** 2).sum(axis=1).mean())

    return _best(points, error)


def _best(points: Array, error: Callable[..., float]) -> Separated:
    best: Separated | None = None
    for direction in directions():
        above = (points - points.mean(axis=0)) @ direction > 0
        upper, lower = np.flatnonzero(above), np.flatnonzero(~above)
        if len(upper) == 0 or len(lower) == 0:
            continue
        distances = np.array(
            [squared_from_line(points[lower], points[x], direction) for x in upper]
        )
        partner = lower[np.argmin(distances, axis=1)]
        midpoints = (points[upper] + points[partner]) / 2
        clearance = min(np.linalg.norm(points - y, axis=1).min() for y in midpoints)
        epsilon = error(upper, lower, partner, distances.min(axis=1))
        score = np.log(clearance + 1) + np.exp(-epsilon)
        if best is None or score > best.score:
            pairs = np.stack([upper, partner], axis=1)
            best = Separated(pairs, direction, epsilon, float(clearance), float(score))
    assert best is not None
    return best


def normals_only(points: Array, normals: Array) -> NDArray[np.int64]:
    """Algorithm 3: the pairs."""
    pairs = []
    for i, (x, normal) in enumerate(zip(points, normals)):
        squared = squared_from_line(points, x, normal)
        squared[i] = np.inf
        pairs.append((i, int(np.argmin(squared))))
    return np.array(pairs)


def simplified(points: Array, count: int) -> Array:
    """2.2.4: the means of the cells of edge l_avg / k, for the first k with enough cells."""
    average = np.linalg.norm(points - points.mean(axis=0), axis=1).mean()
    for k in range(1, 1000):
        cells = np.floor((points - points.min(axis=0)) * (k / average)).astype(int)
        occupied, group = np.unique(cells, axis=0, return_inverse=True)
        if len(occupied) >= count:
            break
    return np.array([points[group.ravel() == g].mean(axis=0) for g in range(len(occupied))])


class Ball(NamedTuple):
    centre: Array
    radius: float
    measure: float


def sphere_measure(points: Array, centre: Array, radius: float) -> float:
    """Algorithm 4, steps 2 and 3: Wendland's function at the closest point to each image."""
    average = np.linalg.norm(points - points.mean(axis=0), axis=1).mean()
    alpha = 15 / average
    u = centre - points
    length = np.linalg.norm(u, axis=1)
    images = points + 2 * ((length - radius) / length)[:, None] * u
    total = 0.0
    for image in images:
        t = alpha / 2.6 * np.linalg.norm(points - image, axis=1).min()
        total += (1 - t) ** 5 * (8 * t**2 + 5 * t + 1) if t <= 1 else 0.0
    return total


def best_candidate(points: Array, radii: Array) -> Ball:
    """Algorithm 4, steps 1 to 4: the best of the spheres midway between each two points."""
    best = Ball(np.zeros(3), 0.0, -1.0)
    for i, a in enumerate(points):
        for b in points[i + 1 :]:
            chord = (a - b) / np.linalg.norm(a - b)
            for side in (1, -1):
                for radius in radii:
                    centre = (a + b) / 2 + side * radius * chord
                    measure = sphere_measure(points, centre, radius)
                    if measure > best.measure:
                        best = Ball(centre, float(radius), measure)
    return best
