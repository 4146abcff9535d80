"""``plane`` on nearly symmetric shapes: smooth asymmetry of known size, landmarks in pairs."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import Plane

from .case import Bar, Case, Figures, at_least, at_most, timed_detect
from .icp import best_plane, multi_start_icp
from .planes import difference
from .poses import Points, diagonal, random_rotation
from .solids import FOLDER, mirrored_mesh, sampled

SUBJECTS = ("cow", "airplane", "face", "skull")
COUNT = 4096
WAVES = 6
WAVELENGTHS = (0.7, 2.0)  # of the diagonal
LANDMARKS = 200  # pairs of points of a mesh whose mirror is exact

Finder = Callable[[Points, np.random.Generator], tuple[Plane, float]]
Faces = NDArray[np.int64]


def smooth_field(points: Points, share: float, rng: np.random.Generator) -> Callable:
    """A sum of long waves, whose greatest length at the points is that share of the diagonal."""
    size = diagonal(points)
    directions = rng.normal(size=(WAVES, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    waves = 2 * np.pi / (size * rng.uniform(*WAVELENGTHS, size=(WAVES, 1))) * directions
    phases, ways = rng.uniform(0, 2 * np.pi, size=WAVES), rng.normal(size=(WAVES, 3))

    def field(x: Points) -> Points:
        return np.cos(x @ waves.T + phases) @ ways

    strength = share * size / np.linalg.norm(field(points), axis=1).max()
    return lambda x: strength * field(x)


@cache
def skulls() -> tuple[str, ...]:
    return tuple(sorted(path.stem for path in (FOLDER / "skulls").glob("*.ply")))


@cache
def skull(name: str) -> tuple[Points, Faces, Points, Points]:
    """A scan, its landmarks and the landmark that mirrors each: itself on the mid-line."""
    shape = symsurf.read(FOLDER / "skulls" / f"{name}.ply")
    marks = np.loadtxt(
        FOLDER / "skulls" / f"{name}_landmarks.csv", delimiter=",", skiprows=1, usecols=(0, 1, 2)
    )
    kept = shape.faces[np.isfinite(shape.points[shape.faces]).all(axis=(1, 2))]
    points = np.nan_to_num(shape.points)
    nearest = min(
        ((marks * signs) for signs in ((1, 1, 1), (-1, -1, 1))),
        key=lambda moved: np.abs(moved.mean(axis=0) - points.mean(axis=0)).sum(),
    )
    plane = Plane((1, 0, 0), -np.median(nearest[:, 0]))
    for _ in range(20):
        gaps = np.linalg.norm(plane.reflect(nearest)[:, None] - nearest[None], axis=2)
        partner = gaps.argmin(axis=1)
        mutual = partner[partner] == np.arange(len(nearest))
        plane = best_plane(nearest[mutual], nearest[partner[mutual]])
    return points, kept, nearest[mutual], nearest[partner[mutual]]


def shape_of(subject: str, rng: np.random.Generator) -> tuple[Points, Faces, Points, Points]:
    """Vertices and faces, landmarks, and those that mirror them."""
    if subject == "skull":
        return skull(str(rng.choice(skulls())))
    vertices, faces, plane = mirrored_mesh(subject)
    marks = sampled(vertices, faces, LANDMARKS, rng)
    return vertices, faces, marks, plane.reflect(marks)


def nearly(
    subject: str, share: float, count: int, rng: np.random.Generator
) -> tuple[Points, Plane, Points, Points]:
    """Points of the deformed shape, the plane that mirrors its landmarks best in the least-squares
    sense, and the landmarks in pairs."""
    vertices, faces, marks, partners = shape_of(subject, rng)
    field = smooth_field(vertices, share, rng)
    rotation = random_rotation(rng)
    points = sampled(vertices, faces, count, rng)
    points, marks, partners = ((x + field(x)) @ rotation.T for x in (points, marks, partners))
    both = np.vstack([marks, partners]), np.vstack([partners, marks])
    return points, best_plane(*both), *both


def _plane(points: Points, rng: np.random.Generator) -> tuple[Plane, float]:
    result, seconds = timed_detect(points, "plane")
    return result.mirror, seconds


def _icp(points: Points, rng: np.random.Generator) -> tuple[Plane, float]:
    return multi_start_icp(points, rng), np.nan


def _case(share: float, name: str, finder: Finder, bars: dict[str, Bar], count: int) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        points, truth, _, _ = nearly(subject, share, count, rng)
        found, seconds = finder(points, rng)
        angle, offset = difference(found, truth, points)
        return {"angle": angle, "within 1 degree": float(angle <= 1), "offset": offset,
                "seconds": seconds}  # fmt: skip

    return Case(f"{name}, asymmetry of {share:.0%}, {count} points", SUBJECTS, run, bars)


BARS = {"angle": at_most(0.25), "within 1 degree": at_least(1)}
CASES = (
    *(_case(share, "plane", _plane, BARS, COUNT) for share in (0.0, 0.01, 0.03)),
    _case(0.03, "plane", _plane, BARS, 50000),
    _case(0.03, "reflective ICP", _icp, {}, COUNT),
)
