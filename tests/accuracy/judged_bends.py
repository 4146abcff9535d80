"""Bent bodies: the free form is found, cylinder and sphere are chosen where true, a bump is seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

import symsurf

from .bodies import BENDS, NEAR, bent_body, image_errors
from .case import Case, Figures, at_least, at_most, timed_detect
from .damage import hole, noise
from .judged_shapes import ONE_PLANE, arched, symmetric, turned_about
from .poses import Points, diagonal
from .solids import sampled

Rng = np.random.Generator

SIZES = (1500, 10_000, 100_000)
COUNT = 10_000
LOST = 0.15  # of the points, in a hole
SAGS = (0.006, 0.05)  # of the diagonal


def _body(rng: Rng) -> str:
    return str(rng.choice(ONE_PLANE))


def _image_error(result: symsurf.Result, points: Points, images: Points) -> float:
    if result.mirror is None:
        return np.inf
    return float(np.median(image_errors(result.mirror, points, images)))


def _free(damage: str) -> Case:
    def run(subject: str, rng: Rng) -> Figures:
        bend, size = subject.split()
        vertices, faces, plane = symmetric(_body(rng), rng)
        points = sampled(vertices, faces, int(size), rng)
        if damage == "a hole":
            points = points[hole(points, LOST, rng)]
        points, images = bent_body(points, plane, bend, rng)
        given = noise(points, 0.01, rng) if damage == "noise 1 %" else points
        result, seconds = timed_detect(given, "auto")
        return {
            "found": float(result.verdict == "found"),
            "image error": _image_error(result, points, images),
            "score": result.score,
            "seconds": seconds,
        }

    subjects = tuple(f"{bend} {size}" for bend in BENDS for size in SIZES)
    bars = {"found": at_least(0.95), "image error": at_most(NEAR)}
    return Case(f"judgement, free forms, {damage}", subjects, run, bars)


def _round(subject: str, rng: Rng) -> Figures:
    vertices, faces, plane = symmetric(_body(rng), rng)
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


HEIGHTS = (0.02, 0.03)  # of the diagonal
RADIUS = 0.12  # of the diagonal
ASIDE = 1.2  # radii of the bump, from the plane
DENSE = 100_000  # points of the body without the bump, which distances are measured to


def _raised(
    points: Points, top: Points, outward: NDArray[np.float64], height: float, radius: float
) -> tuple[Points, NDArray[np.bool_]]:
    """With a bump, and which points are on its upper half."""
    out = np.linalg.norm(points - top, axis=1) / radius
    profile = np.maximum(1 - out**2, 0) ** 2
    return points + height * profile[:, None] * outward, profile > 0.5


def _bump(subject: str, rng: Rng) -> Figures:
    vertices, faces, plane = symmetric(_body(rng), rng)
    size = diagonal(vertices)
    # The bump moves all layers within its radius, so that none crosses another.
    tops = sampled(vertices, faces, 200, rng)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    order = np.argsort(-np.abs(plane.signed_distance(tops)))
    aside = np.abs(plane.signed_distance(tops)) > ASIDE * RADIUS * size
    top = tops[rng.choice(np.flatnonzero(aside))] if aside.any() else tops[order[0]]
    nearest = KDTree(vertices[faces].mean(axis=1)).query(top)[1]
    outward = normals[nearest] / np.linalg.norm(normals[nearest])
    height = rng.uniform(*HEIGHTS) * size
    raised, upper = _raised(
        sampled(vertices, faces, COUNT, rng), top, outward, height, RADIUS * size
    )
    both = np.vstack([raised, sampled(vertices, faces, DENSE, rng)])
    both, _ = bent_body(both, plane, subject, rng)
    shape, flat = both[:COUNT], both[COUNT:]
    result, seconds = timed_detect(shape, "auto")
    seen = _share_seen(shape, flat, upper, result.mirror)
    return {
        "seen": seen,
        "found": float(result.verdict == "found"),
        "score": result.score,
        "seconds": seconds,
    }


def _share_seen(
    shape: Points, flat: Points, upper: NDArray[np.bool_], mirror: symsurf.Mirror | None
) -> float:
    """The part of each way back to the flat body that the asymmetry has, in the median; none where
    a point has no counterpart."""
    if mirror is None:
        return 0.0
    found = symsurf.asymmetry(shape, mirror, threads=1)
    true = flat[KDTree(flat).query(shape[upper])[1]] - shape[upper]
    shares = (np.nan_to_num(found.vector[upper]) * true).sum(axis=1) / (true**2).sum(axis=1)
    return float(np.median(shares))


CASES = (
    *(_free(damage) for damage in ("clean", "noise 1 %", "a hole")),
    Case("judgement, cylinder or sphere", ("cylinder", "sphere"), _round,
         {"right kind": at_least(0.95), "image error": at_most(NEAR)}, trials=50),
    Case("judgement, a bump seen", ("straight", "cylinder", *BENDS), _bump,
         {"seen": at_least(0.85)}),
)  # fmt: skip
