"""``plane`` on sampled meshes: noise, missing parts, uneven density, halves of objects."""

from __future__ import annotations

import numpy as np

from symsurf import Plane

from .case import Case, Figures, at_least, at_most, timed_detect
from .damage import cluttered, falling_density, half, hole, noise
from .poses import Points, diagonal, random_rotation, turned
from .solids import ASYMMETRIC, MESHES, asymmetric, mirrored_mesh, sampled

COUNT = 4096


def difference(found: Plane, truth: Plane, points: Points) -> tuple[float, float]:
    """The angle in degrees, and the planes' distance at the points' centre over the diagonal."""
    cosine = found.normal @ truth.normal
    angle = np.degrees(
        np.arctan2(np.linalg.norm(np.cross(found.normal, truth.normal)), abs(cosine))
    )
    centre = points.mean(axis=0, keepdims=True)
    gap = found.signed_distance(centre) - np.sign(cosine) * truth.signed_distance(centre)
    return float(angle), float(abs(gap[0])) / diagonal(points)


def _damaged(points: Points, truth: Plane, damages: str, rng: np.random.Generator) -> Points:
    if "noise" in damages:
        points = noise(points, 0.02 if "double" in damages else 0.01, rng)
    if "missing" in damages:
        points = points[hole(points, 0.2, rng)]
    if "density" in damages:
        points = points[falling_density(points, 4, rng)]
    if "half" in damages:
        signed = truth.signed_distance(points)
        left = next((kind for kind in ("slab", "thinned") if kind in damages), "piece")
        points = points[half(points, signed, rng, left)]
    return points


def _case(
    name: str,
    damages: str,
    share: str,
    least: float,
    meshes: tuple[str, ...] = (*MESHES, "fox"),
    count: int = COUNT,
) -> Case:
    """`share`: of the trials in which the plane is "found", or in which it is the "right" one, no
    other, at the least."""

    def run(subject: str, rng: np.random.Generator) -> Figures:
        vertices, faces, truth = mirrored_mesh(subject)
        points = _damaged(sampled(vertices, faces, count, rng), truth, damages, rng)
        rotation = random_rotation(rng)
        points, truth = points @ rotation.T, turned(truth, rotation)
        given = points
        if "clutter" in damages:
            given = cluttered(points, 0.1, rng.uniform(1, 5), rng)
        result, seconds = timed_detect(given, "plane")
        angle, offset = difference(result.mirror, truth, points)
        found = float(angle <= 1 and offset <= 0.005)
        right = float(angle <= 5 and offset <= 0.03)
        return {"angle": angle, "offset": offset, "found": found, "right": right,
                "score": result.score, "seconds": seconds}  # fmt: skip

    bars = {"angle": at_most(1), "offset": at_most(0.005), share: at_least(least)}
    return Case(f"plane, {name}", meshes, run, bars)


def _without_mirror(subject: str, rng: np.random.Generator) -> Figures:
    result, seconds = timed_detect(asymmetric(subject, COUNT, rng), "plane")
    return {"at most 0.3": float(result.score <= 0.3), "at most 0.4": float(result.score <= 0.4),
            "score": result.score, "seconds": seconds}  # fmt: skip


CASES = (
    _case("as it is", "", "found", 0.95),
    _case("noise 1 %", "noise", "found", 0.95),
    _case("noise 2 %", "double noise", "found", 0.95),
    _case("20 % missing", "missing", "found", 0.95),
    _case("4:1 density", "density", "found", 0.95),
    _case("all three", "noise missing density", "found", 0.95, MESHES),
    _case("10 % clutter", "clutter", "found", 0.95),
    _case("10 % clutter, 50000 points", "clutter", "found", 0.95, count=50000),
    _case("1000 points", "", "found", 0.95, count=1000),
    _case("1000 points, noise 1 %", "noise", "found", 0.95, count=1000),
    _case("half, a compact 30 % of the other half", "half", "right", 0.9, MESHES),
    _case("half, a thinned 30 % of the other half", "half thinned", "right", 0.9, MESHES),
    _case("half, the 30 % next to the cut", "half slab", "right", 0.9, MESHES),
    Case("plane, no mirror", ASYMMETRIC, _without_mirror, {"at most 0.4": at_least(0.99)}),
)
