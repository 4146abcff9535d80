"""``perpendicular`` on solids whose plane of symmetry was bent, each side with points of its own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .case import Bar, Case, Figures, at_least, at_most, timed_detect
from .damage import noise
from .poses import Points, diagonal, random_rotation
from .solids import ASYMMETRIC, MESHES, asymmetric, mirrored_mesh, sampled

COUNT = 4096
LANDS_WITHIN = 0.015  # of the diagonal

Surface = Callable[[NDArray[np.float64], NDArray[np.float64]], Points]
SURFACES: dict[str, Surface] = {
    "wave": lambda u, v: np.column_stack([u, v, 0.09 * np.sin(4.5 * u)]),
    "saddle": lambda u, v: np.column_stack([u, v, 0.35 * (u * u - v * v) + 0.1 * u * v]),
    "dome": lambda u, v: np.column_stack([u, v, 0.25 * u * u + 0.3 * v * v]),
    "twist": lambda u, v: np.column_stack([v * np.cos(u), v * np.sin(u), u]),
}
"""What the plane of symmetry becomes, over the object's diagonal."""


def normals(surface: Surface, u: NDArray[np.float64], v: NDArray[np.float64]) -> Points:
    step = 1e-5
    along = surface(u + step, v) - surface(u - step, v)
    across = surface(u, v + step) - surface(u, v - step)
    normal = np.cross(along, across)
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)


def deformed(subject: str, rng: np.random.Generator) -> tuple[Points, Points]:
    """Points of a mesh whose plane of symmetry was bent, and their true images."""
    name, bend = subject.split()
    points, faces, plane = mirrored_mesh(name)
    points = sampled(points, faces, COUNT, rng)
    height = plane.signed_distance(points) / diagonal(points)
    across = np.linalg.svd(plane.normal[None])[2][1:]
    u, v = sorted((points @ way for way in across), key=np.ptp, reverse=True)
    u, v = ((x - (x.max() + x.min()) / 2) / diagonal(points) for x in (u, v))
    surface = SURFACES[bend]
    feet, up = surface(u, v), height[:, None] * normals(surface, u, v)
    rotation = random_rotation(rng)
    return (feet + up) @ rotation.T, (feet - up) @ rotation.T


def _deformed(name: str, bars: dict[str, Bar], share: float = 0) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        points, images = deformed(subject, rng)
        noisy = noise(points, share, rng)
        result, seconds = timed_detect(noisy, "perpendicular")
        if result.mirror is None:
            return {"image error": np.inf, "images right": 0.0, "score": 0.0, "seconds": seconds}
        errors = np.linalg.norm(result.mirror.reflect(points) - images, axis=1) / diagonal(points)
        errors[np.isnan(errors)] = np.inf
        return {
            "image error": float(np.median(errors)),
            "images right": float((errors < LANDS_WITHIN).mean()),
            "score": result.score,
            "seconds": seconds,
        }

    subjects = tuple(f"{mesh} {bend}" for mesh in MESHES for bend in SURFACES)
    return Case(f"perpendicular, bent solids, {name}", subjects, run, bars)


def _blob(method: str) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        points = asymmetric(subject, int(rng.choice((1000, 2000, 4000))), rng)
        points = noise(points, float(rng.choice((0, 0.005, 0.01))), rng)
        result, seconds = timed_detect(points, method)
        return {"score": result.score, "low": float(result.score < 0.3), "seconds": seconds}

    return Case(f"{method}, no mirror", ASYMMETRIC, run, {"score": at_most(0.3)})


def _bars(error: float) -> dict[str, Bar]:
    return {"image error": at_most(error), "images right": at_least(0.9)}


CASES = (
    _deformed("clean", _bars(0.003)),
    _deformed("noise 1 %", _bars(0.005), 0.01),
    _blob("perpendicular"),
    _blob("fixed_direction"),
)
