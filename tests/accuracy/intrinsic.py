"""Posed bodies whose truth is known by index: geodesic errors of their intrinsic symmetry."""

from __future__ import annotations

import heapq
import time

import numpy as np
from numpy.typing import NDArray

import symsurf

from .case import Case, Figures, at_least, at_most
from .limbed import BODIES, Body, posed
from .poses import random_rotation

CHECKED = 100  # points whose error is measured
ANGLE = 0.9  # radians, at most, of a joint


def _distances(body: Body, points: NDArray[np.float64], start: int) -> NDArray[np.float64]:
    """Along edges from one point to all (Dijkstra)."""
    distances = np.full(len(points), np.inf)
    distances[start] = 0
    steps = [(0.0, start)]
    while steps:
        distance, at = heapq.heappop(steps)
        if distance > distances[at]:
            continue
        around = body.neighbours[at]
        ways = distance + np.linalg.norm(points[around] - points[at], axis=1)
        for way, to in zip(ways, around):
            if way < distances[to]:
                distances[to] = way
                heapq.heappush(steps, (way, int(to)))
    return distances


def _trial(name: str, rng: np.random.Generator, as_cloud: bool) -> Figures:
    body = BODIES[name]
    points = posed(body, rng, ANGLE) @ random_rotation(rng).T
    start = time.process_time()
    found = symsurf.intrinsic_symmetry(points, faces=None if as_cloud else body.faces, threads=1)
    seconds = time.process_time() - start
    errors, identity, longest = [], [], 0.0
    for i in rng.choice(len(points), CHECKED, replace=False):
        away = _distances(body, points, body.mirrored[i])
        longest = max(longest, away.max())
        errors.append(away[found.image[i]] if found.image[i] >= 0 else np.inf)
        identity.append(away[i])
    return {
        "geodesic error": float(np.mean(errors) / longest),
        "no flip": float(np.mean(errors) < 0.5 * np.mean(identity)),
        "found": float(found.verdict == "found"),
        "seconds": seconds,
    }


BARS = {"geodesic error": at_most(0.03), "no flip": at_least(1)}
CASES = tuple(
    Case(
        f"intrinsic: posed {'clouds' if as_cloud else 'meshes'}",
        tuple(BODIES),
        lambda name, rng, as_cloud=as_cloud: _trial(name, rng, as_cloud),
        BARS,
        trials=20,
    )
    for as_cloud in (False, True)
)
