"""The baseline for planes: iterative closest points under a reflection, from many starts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from symsurf import Plane

from .poses import Points

SEARCHED = 800
"""Points, drawn at random, that the search from all starts goes by."""


def spread_directions(count: int) -> Points:
    """Over a half sphere, on a Fibonacci spiral."""
    height = (np.arange(count) + 0.5) / count
    angle = np.pi * (1 + 5**0.5) * np.arange(count)
    around = np.sqrt(1 - height**2)
    return np.column_stack([around * np.cos(angle), around * np.sin(angle), height])


def best_plane(points: Points, images: Points) -> Plane:
    """The plane whose reflection moves the points nearest to their images, in least squares.

    It passes through the middle of both centroids. With the reflection I - 2 n n', the sum of
    squares is 4 n' C n - m (n . d)^2 but for terms without n: C is the symmetric part of the
    covariance of both, d the difference of the m points' centroid and their images'.
    """
    centre, other = points.mean(axis=0), images.mean(axis=0)
    covariance = (points - centre).T @ (images - other)
    apart = centre - other
    form = 2 * (covariance + covariance.T) - len(points) * np.outer(apart, apart)
    normal = np.linalg.eigh(form)[1][:, 0]
    return Plane(normal, -normal @ (centre + other) / 2)


def refined(plane: Plane, points: Points, iterations: int) -> tuple[Plane, float]:
    """The plane after so many iterations, and the mean squared distance before the last."""
    tree, error = KDTree(points), np.inf
    for _ in range(iterations):
        distances, nearest = tree.query(plane.reflect(points))
        before, error = error, float((distances**2).mean())
        if error > before * (1 - 1e-6):
            break
        plane = best_plane(points, points[nearest])
    return plane, error


def multi_start_icp(points: Points, rng: np.random.Generator) -> Plane:
    """Starts from planes through the centroid, orthogonal to the principal axes and to 30 spread
    directions; the best few of a random subset are refined on all points."""
    centre = points.mean(axis=0)
    axes: NDArray[np.float64] = np.linalg.svd(points - centre, full_matrices=False)[2]
    starts = [Plane(n, -n @ centre) for n in np.vstack([axes, spread_directions(30)])]
    few = points[rng.permutation(len(points))[:SEARCHED]]
    searched = [refined(start, few, 15) for start in starts]
    best = sorted(searched, key=lambda found: found[1])[:5]
    return min((refined(plane, points, 30) for plane, _ in best), key=lambda found: found[1])[0]
