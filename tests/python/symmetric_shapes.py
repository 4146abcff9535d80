"""Shapes with one known mirror plane, and moves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import symsurf


def mirrored_surface(count: int, seed: int) -> tuple[NDArray[np.float64], symsurf.Plane]:
    """A bumpy closed surface without other symmetries, mirrored exactly in a plane of any pose."""
    rng = np.random.default_rng(seed)
    half = rng.normal(size=(count // 2, 3))
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    half[:, 0] = np.abs(half[:, 0])
    x, y, z = half.T
    radius = 1 + 0.3 * np.sin(3 * y + 1) + 0.25 * np.cos(2 * z - 0.5) * y + 0.2 * z * x**2
    half = half * radius[:, None] * (1.0, 1.4, 0.8)
    points = np.vstack([half, half * (-1, 1, 1)])
    rotation, shift = random_rotation(rng), rng.normal(size=3)
    normal = rotation[:, 0]
    order = rng.permutation(len(points))
    return (points @ rotation.T + shift)[order], symsurf.Plane(normal, -normal @ shift)


def lopsided_blob(count: int) -> NDArray[np.float64]:
    """A bumpy closed surface without a mirror."""
    u = np.random.default_rng(0).normal(size=(count, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    x, y, z = u.T
    radius = 1 + 0.4 * np.sin(3 * x + 1) * np.cos(4 * y + 0.5) + 0.3 * np.sin(5 * z + 2 * x)
    return u * radius[:, None]


def random_rotation(rng: np.random.Generator) -> NDArray[np.float64]:
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return rotation * np.sign(np.linalg.det(rotation))


def diagonal(points: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def difference(
    found: symsurf.Plane, truth: symsurf.Plane, points: NDArray[np.float64]
) -> tuple[float, float]:
    """The angle between planes in degrees, and how far they are apart at the points' centre as a
    fraction of the diagonal."""
    sign = 1 if found.normal @ truth.normal >= 0 else -1
    sine = np.linalg.norm(np.cross(found.normal, truth.normal))
    centre = points.mean(axis=0, keepdims=True)
    gap = found.signed_distance(centre)[0] - sign * truth.signed_distance(centre)[0]
    angle = np.degrees(np.arctan2(sine, abs(found.normal @ truth.normal)))
    return float(angle), abs(gap) / diagonal(points)


def is_near(mirror, normal, on, within=0.01):
    angle = np.degrees(np.arccos(min(1, abs(mirror.normal @ normal))))
    return angle < 0.6 and abs(mirror.normal @ on + mirror.offset) < within


def quick(method: str) -> dict[str, int]:
    """Parameters with which a method takes seconds where its own would take minutes."""
    return {"sphere_thesis": {"radii": 2, "sample_size": 100}}.get(method, {})
