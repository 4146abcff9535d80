"""What the points of two layers say about the mirror between them, to one who knows it already."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from symsurf import Mirror

from .poses import Points

NEIGHBOURS = 12  # of an image, in the other layer; a quadratic surface has six numbers
AROUND = 64  # feet that are averaged at most
BANDWIDTHS = (0.01, 1, 1.5, 2, 3, 4, 6)  # spacings of the feet; the least averages nothing


def from_pairs(points: Points, pairs: np.ndarray, clean: Points) -> list[Points]:
    """Surface points by the true pairs, which lay at ``clean`` before damage, for each of the
    BANDWIDTHS."""
    middle = (points[pairs[:, 0]] + points[pairs[:, 1]]) / 2
    feet = (clean[pairs[:, 0]] + clean[pairs[:, 1]]) / 2
    normal = clean[pairs[:, 0]] - clean[pairs[:, 1]]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return _averaged(feet, normal, ((middle - feet) * normal).sum(axis=1))


def from_layers(points: Points, truth: Mirror) -> list[Points]:
    """The same where no point has a partner, by one step from the true mirror.

    The image of each point lies somewhat off the other layer, a quadratic surface through the nearest
    points there. The mirror moves by half of that along its normal.
    """
    height = truth.signed_distance(points)
    usable = np.isfinite(height) & (np.abs(height) > 0)
    points, height = points[usable], height[usable]
    feet, images = truth.project(points), truth.reflect(points)
    normal = (points - feet) / height[:, None]
    off = np.full(len(feet), np.nan)
    for side in (-1, 1):
        here = np.sign(height) == side
        there = points[~here]
        if len(there) < NEIGHBOURS or not here.any():
            continue
        near = there[KDTree(there).query(images[here], NEIGHBOURS)[1]] - images[here][:, None]
        along = (near @ normal[here][:, :, None])[:, :, 0]
        off[here] = _heights_at_0(_across(near, normal[here]), along, np.ones_like(along), 2) / 2
    known = np.isfinite(off)
    return _averaged(feet[known], normal[known], off[known])


def _averaged(feet: Points, normal: Points, off: np.ndarray) -> list[Points]:
    """The feet moved along the normals by what is off, averaged by local linear regression."""
    distance, rows = KDTree(feet).query(feet, min(AROUND, len(feet)))
    uv = _across(feet[rows] - feet[:, None], normal)
    spacing = np.median(distance[:, 1])
    surfaces = []
    for bandwidth in BANDWIDTHS:
        weights = np.exp(-((distance / (bandwidth * spacing)) ** 2) / 2)
        surfaces.append(feet + _heights_at_0(uv, off[rows], weights, 1)[:, None] * normal)
    return surfaces


def _across(offsets: np.ndarray, normal: Points) -> np.ndarray:
    """(n, k, 2): offsets (n, k, 3) in the tangent planes, over their size."""
    ways = np.linalg.svd(normal[:, None, :])[2][:, 1:]
    uv = offsets @ np.swapaxes(ways, 1, 2)
    return uv / (np.abs(uv).max(axis=(1, 2), keepdims=True) + 1e-300)


def _heights_at_0(uv: np.ndarray, z: np.ndarray, weights: np.ndarray, degree: int) -> np.ndarray:
    """Of polynomials fitted to z over uv, (n, k, 2), by weighted least squares."""
    u, v = uv[..., 0], uv[..., 1]
    terms = [np.ones_like(u), u, v] + ([u * u, u * v, v * v] if degree == 2 else [])
    design = np.stack(terms, axis=2)
    left = np.swapaxes(design, 1, 2) @ (weights[:, :, None] * design)
    left += 1e-9 * np.eye(len(terms)) * weights.sum(axis=1)[:, None, None]
    right = np.swapaxes(design, 1, 2) @ (weights * z)[:, :, None]
    return np.linalg.solve(left, right)[:, 0, 0]
