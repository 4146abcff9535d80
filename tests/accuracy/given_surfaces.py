"""Mirrors through points that lie on them: `fit_mirror`."""

from __future__ import annotations

import time

import numpy as np

import symsurf
from symsurf import Cylinder, Mirror, Plane, Quadric, Sphere

from .case import Case, Figures, at_least
from .damage import noise
from .poses import Points, diagonal, random_rotation

KINDS = ("plane", "sphere", "cylinder", "quadric")
COUNT = 1000
NEAR, CLOSE = 0.1, 0.01  # of the diagonal: points that are mirrored, and right images


def _drawn(kind: str, rng: np.random.Generator) -> tuple[Points, Mirror]:
    """Points on a mirror in its own frame, about 2 wide."""
    u, v = rng.uniform(-1, 1, size=(2, COUNT))
    radius = rng.uniform(1, 2)
    if kind == "plane":
        return np.column_stack([u, v, 0 * u]), Plane((0, 0, 1), 0.0)
    if kind == "sphere":
        ways = np.column_stack([u, v, np.ones(COUNT)])
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        return radius * ways, Sphere((0, 0, 0), radius)
    if kind == "cylinder":
        around = np.column_stack([radius * np.sin(u), v, radius * np.cos(u)])
        return around, Cylinder((0, 0, 0), (0, 1, 0), radius)
    a, b = rng.uniform((0.2, -0.8), 0.8)
    return np.column_stack([u, v, a * u**2 + b * v**2]), Quadric(np.diag([a, b, 0]), (0, 0, -1), 0)


def _through(name: str, level: float, lost: float) -> Case:
    def run(kind: str, rng: np.random.Generator) -> Figures:
        rotation = random_rotation(rng)
        points, truth = _drawn(kind, rng)
        beside = points + NEAR * diagonal(points) * rng.uniform(-1, 1, size=points.shape)
        away = np.linalg.norm(points - points[rng.integers(COUNT)], axis=1)
        given = noise(points[np.argsort(away)[int(lost * COUNT) :]], level, rng) @ rotation
        start = time.process_time()
        found = symsurf.fit_mirror(given)
        seconds = time.process_time() - start
        images = truth.reflect(beside)
        rows = np.isfinite(images).all(axis=1)
        off = np.linalg.norm(found.reflect(beside @ rotation) - images @ rotation, axis=1)[rows]
        return {
            "right images": float(np.mean(off < CLOSE * diagonal(points))),
            "right kind": float(found.kind == kind),
            "seconds": seconds,
        }

    bars = {"right images": at_least(0.95), "right kind": at_least(1)}
    return Case(f"through points: {name}", KINDS, run, bars)


CASES = (
    _through("exact", 0, 0),
    _through("noise 1 %", 0.01, 0),
    _through("noise 1 %, a third cut", 0.01, 1 / 3),
)
