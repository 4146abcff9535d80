"""Two shapes of a pair, sampled apart, each in a pose of its own: the reflection that lays one on the other."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import symsurf

from .case import Case, Figures, at_least, at_most
from .damage import hole, noise
from .poses import Points, random_rotation
from .solids import asymmetric

COUNT = 10000
SUBJECTS = ("bumpy", "lumps", "facets", "sheet", "bone")


def _bone(count: int, rng: np.random.Generator) -> Points:
    """A shaft with a head on a neck, a trochanter and two condyles: balls and rods, outside only."""
    joints = np.array([[0, 0, -1], [0.03, 0.08, 0], [0, 0, 0.9], [0.25, 0.08, 1.1], [-0.12, -0.05, 0.95],
                       [0.14, -0.05, -1.02], [-0.13, -0.09, -1.0]])  # fmt: skip
    joints += rng.normal(size=joints.shape) * 0.04
    radii = np.array([0.1, 0.08, 0.1, 0.16, 0.12, 0.14, 0.12]) * rng.uniform(0.85, 1.15, size=7)
    rods = [(0, 1), (1, 2), (2, 3), (2, 4), (0, 5), (0, 6)]
    kept: list[Points] = []
    while sum(map(len, kept)) < count:
        j, k = rods[rng.integers(len(rods))] if rng.random() < 0.6 else (rng.integers(7),) * 2
        t = rng.random((count // 4, 1))
        ways = rng.normal(size=(len(t), 3))
        if j != k:
            ways -= np.outer(ways @ (joints[k] - joints[j]), joints[k] - joints[j]) / np.sum(
                (joints[k] - joints[j]) ** 2)  # fmt: skip
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        points = (1 - t) * joints[j] + t * joints[k] + ((1 - t) * radii[j] + t * radii[k]) * ways
        kept.append(points[_outside(points, joints, radii, rods)])
    return rng.permutation(np.vstack(kept))[:count]


def _outside(points: Points, joints: Points, radii: NDArray[np.float64], rods: list[tuple[int, int]]
             ) -> NDArray[np.bool_]:  # fmt: skip
    outside = np.ones(len(points), bool)
    for a, b in [*rods, *((k, k) for k in range(len(joints)))]:
        way = joints[b] - joints[a]
        t = np.clip((points - joints[a]) @ way / max(way @ way, 1e-12), 0, 1)[:, None]
        off = np.linalg.norm(points - joints[a] - t * way, axis=1)
        outside &= off > ((1 - t) * radii[a] + t * radii[b])[:, 0] - 1e-3
    return outside


def _body(subject: str, count: int, rng: np.random.Generator) -> Points:
    return _bone(count, rng) if subject == "bone" else asymmetric(subject, count, rng)


def _posed(points: Points, rng: np.random.Generator) -> tuple[Points, NDArray[np.float64]]:
    rotation = random_rotation(rng)
    return points @ rotation.T + rng.normal(size=3), rotation


def degrees_between(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.degrees(2 * np.arcsin(min(1, np.linalg.norm(a - b) / np.sqrt(8)))))


def _case(name: str, share: float, lost: tuple[float, float], thinned: float = 1) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        points = rng.permutation(_body(subject, 2 * COUNT, rng))
        sides = points[:COUNT], points[COUNT:] * (-1, 1, 1)
        damaged = [side[hole(side, part, rng)] for side, part in zip(sides, lost)]
        damaged[1] = damaged[1][: round(thinned * len(damaged[1]))]
        (left, own), (right, other) = (_posed(noise(side, share, rng), rng) for side in damaged)
        start = time.process_time()
        match = symsurf.match_pair(left, right, threads=1)
        seconds = time.process_time() - start
        error = degrees_between(match.matrix[:3, :3], other @ np.diag([-1, 1, 1]) @ own.T)
        return {
            "rotation error": error,
            "within 1 degree": float(error <= 1),
            "found": float(match.verdict == "found"),
            "score": match.score,
            "evidence": match.statistics["evidence"],
            "seconds": seconds,
        }

    bars = {
        "rotation error": at_most(1),
        "within 1 degree": at_least(0.97),
        "seconds": at_most(0.5),
    }
    return Case(f"match_pair, {name}", SUBJECTS, run, bars, 12)


def _others(subject: str, rng: np.random.Generator) -> Figures:
    """Two bodies of a sort that are no pair, every other time with noise."""
    share = rng.choice([0, 0.01])
    left, right = (_posed(noise(_body(subject, COUNT, rng), share, rng), rng)[0] for _ in range(2))
    match = symsurf.match_pair(left, right, threads=1)
    return {
        "verdict none": float(match.verdict == "none"),
        "score": match.score,
        "evidence": match.statistics["evidence"],
    }


CASES = (
    _case("whole", 0, (0, 0)),
    _case("30 % of one lost", 0, (0.3, 0)),
    _case("30 % of both lost", 0, (0.3, 0.3)),
    _case("noise 1 %", 0.01, (0, 0)),
    _case("other sampling", 0, (0, 0), 0.3),
    Case("match_pair, no pair", SUBJECTS, _others, {"verdict none": at_least(0.97)}, 12),
)
