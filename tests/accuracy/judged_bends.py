"""Bent bodies: the free form is found, cylinder and sphere are chosen where true, a bump is seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

import symsurf
from symsurf import Plane

from .bodies import BENDS, NEAR, bent_body, image_errors
from .case import Case, Figures, at_least, at_most, timed_detect
from .damage import hole, noise
from .judged_shapes import ONE_PLANE, arched, one_of, symmetric, turned_about
from .operations import BUMP_RADIUS, bumped
from .poses import Points, diagonal
from .solids import sampled

Rng = np.random.Generator

SIZES = (1500, 10_000, 100_000)
COUNT = 10_000
LOST = 0.15  # of the points, in a hole
SAGS = (0.006, 0.05)  # of the diagonal


def _image_error(result: symsurf.Result, points: Points, images: Points) -> float:
    if result.mirror is None:
        return np.inf
    return float(np.median(image_errors(result.mirror, points, images)))


def _free(damage: str) -> Case:
    def run(subject: str, rng: Rng) -> Figures:
        size = int(rng.choice(SIZES))
        vertices, faces, plane = symmetric(one_of(ONE_PLANE, rng), rng)
        points = sampled(vertices, faces, size, rng)
        if damage == "a hole":
            points = points[hole(points, LOST, rng)]
        points, images = bent_body(points, plane, subject, rng)
        given = noise(points, 0.01, rng) if damage == "noise 1 %" else points
        result, seconds = timed_detect(given, "auto")
        found = float(result.verdict == "found")
        return {
            "found": found,
            "image error": _image_error(result, points, images),
            "score": result.score,
            f"found, {size}": found,
            f"seconds, {size}": seconds,
        }

    bars = {"found": at_least(0.95), "image error": at_most(NEAR)}
    return Case(f"judgement, free forms, {damage}", tuple(BENDS), run, bars)


def _round(subject: str, rng: Rng) -> Figures:
    vertices, faces, plane = symmetric(one_of(ONE_PLANE, rng), rng)
    sag = np.exp(rng.uniform(*np.log(SAGS)))
    points, images = turned_about(
        *arched(sampled(vertices, faces, COUNT, rng), plane, subject, sag), rng
    )
    result, seconds = timed_detect(points, "auto")
    kind = result.mirror.kind if result.mirror else ""
    figures = {
        "right kind": float(kind == subject),
        "image error": _image_error(result, points, images),
        "found": float(result.verdict == "found"),
        "score": result.score,
        "seconds": seconds,
    }
    low = "sag < 1.5 %" if sag < 0.015 else "sag >= 1.5 %"
    return {**figures, f"right, {low}": figures["right kind"]}


BUMPED = ("cow", "face", "blob")
"""Bodies thick enough for a bump on one side of them."""
HEIGHTS = (0.02, 0.03)  # of the diagonal
UPPER = 0.6  # of the greatest height: where the bump is measured
DENSE = 100_000  # points of the body without the bump, which distances are measured to


def _wide(rng: Rng) -> tuple[Points, NDArray[np.int64], Plane]:
    """One of BUMPED that reaches so far from its plane that a bump does not touch it."""
    while True:
        vertices, faces, plane = symmetric(one_of(BUMPED, rng), rng)
        reach = np.abs(plane.signed_distance(vertices)).max()
        if reach > 1.3 * BUMP_RADIUS * diagonal(vertices):
            return vertices, faces, plane


def _bump(subject: str, rng: Rng) -> Figures:
    vertices, faces, plane = _wide(rng)
    height = rng.uniform(*HEIGHTS) * diagonal(vertices)
    raised, _, _ = bumped(vertices, faces, plane, height, rng)
    both = np.vstack([sampled(raised, faces, COUNT, rng), sampled(vertices, faces, DENSE, rng)])
    both, _ = bent_body(both, plane, subject, rng)
    shape, flat = both[:COUNT], both[COUNT:]
    result, seconds = timed_detect(shape, "auto")
    return {
        "seen": _share_seen(shape, flat, result.mirror),
        "found": float(result.verdict == "found"),
        "score": result.score,
        "seconds": seconds,
    }


def _share_seen(shape: Points, flat: Points, mirror: symsurf.Mirror | None) -> float:
    """The part of each way back to the flat body that the asymmetry has, in the median over the
    bump; none where a point has no counterpart."""
    if mirror is None:
        return 0.0
    distance, nearest = KDTree(flat).query(shape)
    upper = distance > UPPER * distance.max()
    way = flat[nearest[upper]] - shape[upper]
    vector = np.nan_to_num(symsurf.asymmetry(shape, mirror, threads=1).vector[upper])
    return float(np.median((vector * way).sum(axis=1) / (way**2).sum(axis=1)))


CASES = (
    *(_free(damage) for damage in ("clean", "noise 1 %", "a hole")),
    Case("judgement, cylinder or sphere", ("cylinder", "sphere"), _round,
         {"right kind": at_least(0.95), "image error": at_most(NEAR)}, trials=50),
    Case("judgement, a bump seen", ("straight", "cylinder", *BENDS), _bump,
         {"seen": at_least(0.85)}),
)  # fmt: skip
