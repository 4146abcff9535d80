"""The verdict: "found" and a plane for straight symmetric bodies, "none" for what has no mirror."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from symsurf import Plane

from .case import Case, Figures, at_least, at_most, timed_detect
from .damage import noise
from .icp import best_plane
from .judged_shapes import SYMMETRIC, Cut, matched, symmetric
from .mirrorless import BODIES, HANDED, mirrorless
from .nearly_symmetric import smooth_field
from .poses import Points, random_rotation
from .solids import sampled

Rng = np.random.Generator
Damaged = tuple[Points, Plane]
"""What is left, and its true plane."""

COUNT = 4096
SIZES = (1000, 4000, 10_000)
SCANS = ("cow", "face", "skull", "blob")
TIMED_SIZES = (1000, 4000, 10_000, 100_000)
TIMED_RUNS = 3  # of ``plane``, whose least time counts


def _whole(points: Points, plane: Plane, rng: Rng) -> Damaged:
    return points, plane


def _noisy(points: Points, plane: Plane, rng: Rng) -> Damaged:
    return noise(points, 0.01, rng), plane


def _unlike(points: Points, plane: Plane, rng: Rng) -> Damaged:
    """With the plane that is nearest to exchanging what the two sides have become."""
    field, images = smooth_field(points, 0.01, rng), plane.reflect(points)
    points, images = points + field(points), images + field(images)
    both = np.vstack([points, images]), np.vstack([images, points])
    return points, best_plane(*both)


def _cut(points: Points, plane: Plane, rng: Rng) -> Damaged:
    """Two fifths of one side, a fifth of all, are gone."""
    return points[Cut(points, plane, rng).kept(0.4)[0]], plane


def _found(name: str, damage: Callable[[Points, Plane, Rng], Damaged]) -> Case:
    def run(subject: str, rng: Rng) -> Figures:
        vertices, faces, plane = symmetric(subject, rng)
        points, truth = damage(sampled(vertices, faces, COUNT, rng), plane, rng)
        result, seconds = timed_detect(points, "auto")
        found = result.verdict == "found"
        kind = result.mirror.kind if result.mirror else ""
        return {
            "found plane": float(found and kind == "plane"),
            "found": float(found),
            "kind plane": float(kind == "plane"),
            "score": result.score,
            "true plane": matched(points, truth),
            "seconds": seconds,
        }

    return Case(f"judgement, found: {name}", SYMMETRIC, run, {"found plane": at_least(0.98)})


def _none(name: str, subjects: tuple[str, ...], least: float, trials: int) -> Case:
    def run(subject: str, rng: Rng) -> Figures:
        points = mirrorless(subject, int(rng.choice(SIZES)), rng) @ random_rotation(rng).T
        result, seconds = timed_detect(points, "auto")
        kind = result.mirror.kind if result.mirror and result.verdict == "found" else ""
        kinds = {"plane": kind == "plane", "round": kind in ("cylinder", "sphere")}
        return {
            "none": float(result.verdict == "none"),
            "found plane": float(kinds["plane"]),
            "found round": float(kinds["round"]),
            "found free": float(bool(kind) and not any(kinds.values())),
            "score": result.score,
            "seconds": seconds,
        }

    return Case(f"judgement, none: {name}", subjects, run, {"none": at_least(least)}, trials)


def _time(subject: str, rng: Rng) -> Figures:
    body, size = subject.split()
    vertices, faces, _ = symmetric(body, rng)
    points = sampled(vertices, faces, int(size), rng)
    plane = min(timed_detect(points, "plane")[1] for _ in range(TIMED_RUNS))
    result, seconds = timed_detect(points, "auto")
    return {"times plane": seconds / plane, "within 3": float(seconds <= 3 * plane),
            "score": result.score, "seconds": seconds}  # fmt: skip


CASES = (
    _found("whole", _whole),
    _found("noise 1 %", _noisy),
    _found("1 % asymmetric", _unlike),
    _found("20 % cut", _cut),
    _none("bodies", BODIES, 0.97, 25),
    _none("rooms", ("room",), 0.97, 50),
    _none("table tops", ("table top",), 0.97, 100),
    _none("terrain", ("terrain",), 0.97, 50),
    _none("handed", HANDED, 0.95, 20),
    Case("judgement, time of auto over plane",
         tuple(f"{body} {size}" for size in TIMED_SIZES for body in SCANS), _time,
         {"times plane": at_most(3), "within 3": at_least(1)}, trials=7),
)  # fmt: skip
