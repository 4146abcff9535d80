"""Sheared bodies: the oblique plane and the direction it mirrors along."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import symsurf
from symsurf import ObliquePlane

from .case import Case, Figures, at_least, at_most, timed_detect
from .damage import noise
from .judged_shapes import ONE_PLANE, symmetric
from .poses import Points, diagonal
from .solids import sampled

Rng = np.random.Generator
COUNT = 5000
ANGLES = (3.0, 45.0)  # degrees
CLOSE = 0.005  # of the diagonal: half the images


def _whole(points: Points, rng: Rng) -> Points:
    return points


def _noisy(points: Points, rng: Rng) -> Points:
    return noise(points, 0.01, rng)


def _lacking(share: float) -> Callable[[Points, Rng], Points]:
    def cut(points: Points, rng: Rng) -> Points:
        """Without what is nearest to a point drawn from them."""
        distance = np.linalg.norm(points - points[rng.integers(len(points))], axis=1)
        return points[np.argsort(distance)[int(share * len(points)) :]]

    return cut


def _sheared(name: str, damage: Callable[[Points, Rng], Points], method: str) -> Case:
    def run(subject: str, rng: Rng) -> Figures:
        vertices, faces, plane = symmetric(subject, rng)
        points = sampled(vertices, faces, COUNT, rng)
        along = np.cross(plane.normal, rng.normal(size=3))
        angle = rng.uniform(*ANGLES)
        slope = np.tan(np.radians(angle)) * along / np.linalg.norm(along)
        body = points + plane.signed_distance(points)[:, None] * slope
        truth = ObliquePlane(plane.normal, plane.offset, plane.normal + slope)
        result, seconds = timed_detect(damage(body, rng), method)
        figures = {
            "image error": np.inf,
            "found": float(result.verdict == "found"),
            "oblique": float(isinstance(result.mirror, ObliquePlane)),
            "seconds": seconds,
        }
        if result.mirror is None:
            return figures
        off = np.linalg.norm(result.mirror.reflect(body) - truth.reflect(body), axis=1)
        figures["image error"] = float(np.nanmedian(off)) / diagonal(body)
        straight = symsurf.bend(body, result.mirror)
        figures["angle left"] = _angle_left(straight, result.mirror, points, plane.reflect(points))
        return figures

    bars = {"image error": at_most(CLOSE)}
    if method == "auto":
        bars["oblique"] = at_least(0.97)
    return Case(f"oblique, {method}: {name}", ONE_PLANE[:5], run, bars)


def _angle_left(straight: Points, mirror: symsurf.Mirror, body: Points, images: Points) -> float:
    """Degrees between the chords of the straightened body and the normal of its plane."""
    # The affine map that straightened the body takes its images along.
    padded = np.column_stack([body, np.ones(len(body))])
    affine = np.linalg.lstsq(padded, straight, rcond=None)[0]
    chords = straight - np.column_stack([images, np.ones(len(images))]) @ affine
    normal = symsurf.straight_mirror(mirror, body).normal
    along = np.abs(chords @ normal).sum() / np.linalg.norm(chords, axis=1).sum()
    return float(np.degrees(np.arccos(min(1.0, along))))


CASES = tuple(
    _sheared(name, damage, method)
    for method in ("oblique_plane", "auto")
    for name, damage in (
        ("whole", _whole),
        ("noise 1 %", _noisy),
        ("10 % cut", _lacking(0.1)),
        ("20 % cut", _lacking(0.2)),
    )
)
