"""Damage by share of the diagonal and of the points; each gives the points and the rows kept."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .poses import Points, diagonal

Rows = NDArray[np.int64]


def noise(points: Points, share: float, rng: np.random.Generator) -> Points:
    """Normal noise whose root mean square is that share of the diagonal."""
    return points + rng.normal(size=points.shape) * share * diagonal(points) / np.sqrt(3)


def cluttered(points: Points, share: float, times: float, rng: np.random.Generator) -> Points:
    """With that share of the points more, anywhere in a box so many times as large as theirs."""
    low, high = points.min(axis=0), points.max(axis=0)
    places = rng.uniform(-times / 2, times / 2, size=(round(share * len(points)), 3))
    return np.vstack([points, (low + high) / 2 + places * (high - low)])


def hole(points: Points, share: float, rng: np.random.Generator) -> Rows:
    """What is left when that share of the points around one of them is missing."""
    centre = points[rng.integers(len(points))]
    nearest_first = np.argsort(np.linalg.norm(points - centre, axis=1), kind="stable")
    return np.sort(nearest_first[round(share * len(points)) :])


def falling_density(points: Points, ratio: float, rng: np.random.Generator) -> Rows:
    """Along a random direction the chance to be kept falls from 1 to 1 / ratio."""
    along = points @ rng.normal(size=3)
    along = (along - along.min()) / np.ptp(along)
    return np.flatnonzero(rng.random(len(points)) < 1 - (1 - 1 / ratio) * along)


def half(
    points: Points, signed: NDArray[np.float64], rng: np.random.Generator, left: str = "piece"
) -> Rows:
    """One side of a mirror, and 30 % of the points on the other: a compact "piece", the "slab" next
    to the cut, or any, "thinned"."""
    signed = signed * rng.choice([-1, 1])
    other = np.flatnonzero(signed < 0)
    centre = points[rng.choice(other)]
    if left == "slab":
        order = -signed[other]
    elif left == "thinned":
        order = rng.random(len(other))
    else:
        order = np.linalg.norm(points[other] - centre, axis=1)
    nearest_first = np.argsort(order, kind="stable")
    piece = other[nearest_first[: round(0.3 * len(other))]]
    return np.sort(np.concatenate([np.flatnonzero(signed >= 0), piece]))
