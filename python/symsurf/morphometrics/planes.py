"""The plane that pairs of landmarks say."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._core import InvalidInput, Plane
from ..shapes import Landmarks
from .checks import indices_of, pairs_of, points_of
from .pairing import LandmarkPairs

_SEPARATION = 1e-9  # of eigenvalues, of their scale: far above rounding
_TO_SIDE = np.array([4.0, 2, 1])  # that normals point to, those of ``detect`` too


def plane_of_landmarks(
    points: ArrayLike | Landmarks,
    pairs: ArrayLike | LandmarkPairs,
    midline: ArrayLike = (),
) -> Plane:
    """The least-squares mirror plane of pairs of landmarks and of landmarks on the midline.

    With x' the landmark that mirrors x, itself on the midline, it minimises the sum of
    ``|reflect(x) - x'|**2``: the landmarks, relabelled and reflected, are superimposed on themselves
    (Mardia, Bookstein and Moreton 2000). The plane goes through the centroid; its normal is the
    eigenvector to the least eigenvalue of the sum of ``x x'^T`` about that, and points to the side of
    (4, 2, 1), as that of ``detect``.

    Args:
        points: (k, 3). Pairs with a missing landmark, and missing ones of the midline, are left out.
        pairs: (p, 2) indices, or what ``landmark_pairs`` gives, with its midline.
        midline: (m,) indices.

    Raises InvalidInput for landmarks that leave the plane open, such as two on the midline alone,
    and for indices that are out of range or stand twice.
    """
    array = points_of(points)
    if isinstance(pairs, LandmarkPairs):
        both, alone = pairs.pairs, pairs.midline
    else:
        both = pairs_of(pairs, len(array))
        alone = indices_of(midline, len(array), "midline").reshape(-1)
    ends = np.concatenate([both, both[:, ::-1], np.column_stack([alone, alone])])
    x, partner = array[ends[:, 0]], array[ends[:, 1]]
    there = np.isfinite(x).all(axis=1) & np.isfinite(partner).all(axis=1)
    x, partner = x[there], partner[there]
    if not len(x):
        raise InvalidInput(
            "there are no landmarks to lay a plane through; allowed is at least a pair"
        )
    centroid = x.mean(axis=0)
    values, vectors = np.linalg.eigh((x - centroid).T @ (partner - centroid))
    if values[1] - values[0] <= _SEPARATION * max(np.abs(values).max(), np.finfo(float).tiny):
        raise InvalidInput(
            "the landmarks leave the plane open; allowed are a pair, or three in all"
        )
    normal = vectors[:, 0] * (-1 if vectors[:, 0] @ _TO_SIDE < 0 else 1)
    return Plane(normal, -float(normal @ centroid))
