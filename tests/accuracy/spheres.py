"""``sphere`` on surfaces of the thesis and others over spheres that a seed draws, in drawn poses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from symsurf import Sphere, metrics, synthetic

from .case import Case, Figures, at_most, timed_detect
from .damage import falling_density, hole, noise
from .poses import Points, diagonal, random_rotation

Rng = np.random.Generator
Draw = tuple[Points, Sphere]
SURFACES = ("f6", "f1", "f5", "f4", "f3")
LEAST_POINTS = 400
COUNT = 1500  # points of shapes that are not of the thesis


def _mirrored(half: Points, sphere: Sphere, rng: Rng) -> Draw:
    """The half and its image, in a pose of their own."""
    points = synthetic.mirror_spherical(half, sphere.centre, sphere.radius).points
    rotation, scale, shift = random_rotation(rng), 10 ** rng.uniform(-2, 2), rng.normal(size=3)
    centre = scale * (rotation @ sphere.centre + shift)
    points = scale * (points @ rotation.T + shift)[rng.permutation(len(points))]
    return points, Sphere(centre, scale * sphere.radius)


def _cut(cloud: Points, rng: Rng, least_points: float = LEAST_POINTS) -> Draw:
    """Thesis 5.1.3: a sphere between two points, of a radius about a quarter of the diagonal."""
    while True:
        first, second = cloud[rng.choice(len(cloud), 2, replace=False)]
        radius = diagonal(cloud) / rng.uniform(2.5, 4.5)
        sphere = synthetic.sphere_between(first, second, radius)
        inside = np.linalg.norm(cloud - sphere.centre, axis=1) < radius
        if 2 * inside.sum() >= least_points:
            return _mirrored(cloud, sphere, rng)


def thesis(surface: str, rng: Rng, resolution: int = 32) -> Draw:
    cloud = synthetic.surface(surface).sample(1.0 if surface == "f6" else 2.0, resolution)
    return _cut(cloud, rng, LEAST_POINTS * (resolution / 32) ** 2)


def dense_thesis(surface: str, rng: Rng) -> Draw:
    return thesis(surface, rng, 100)


def _waves(xy: Points, steep: float, rng: Rng) -> Points:
    waves, phases = steep * rng.normal(size=(4, 2)), rng.uniform(0, 6, 4)
    return np.sin(xy @ waves.T + phases).sum(axis=1)


def random_shape(shape: str, rng: Rng) -> Draw:
    """A relief that is mirrored, or a closed bumpy body that a sphere goes through."""
    if shape == "relief":
        xy = rng.uniform(-2, 2, (COUNT, 2))
        return _cut(np.column_stack([xy, 0.3 * _waves(xy, 1, rng)]), rng)
    u = rng.normal(size=(COUNT, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    bumps = np.sin(u @ (2 * rng.normal(size=(3, 3))).T + rng.uniform(0, 6, 3)).sum(axis=1)
    half = u * (1 + 0.15 * bumps)[:, None] * (1.3, 1, 0.8)
    size = diagonal(half) * rng.uniform(0.5, 1)
    away = rng.normal(size=3)
    sphere = Sphere(0.8 * size * away / np.linalg.norm(away), size)
    return _mirrored(half, sphere, rng)


def wide(subject: str, rng: Rng) -> Draw:
    """A random relief and its image in a sphere so large that it is nearly a plane."""
    xy = rng.uniform(-0.5, 0.5, (COUNT, 2))
    cloud = np.column_stack([xy, -0.35 - 0.05 * _waves(xy, 4, rng)])
    radius = float(subject.split()[0]) * diagonal(np.vstack([cloud, cloud * (1, 1, -1)]))
    return _mirrored(cloud, Sphere((0, 0, -radius), radius), rng)


Damage = Callable[[Points, Rng], Points]
DAMAGES: dict[str, Damage] = {
    "clean": lambda points, rng: points,
    # Random directions, distances uniform up to a share of the diagonal (thesis 5.3).
    "noise 1 %": lambda points, rng: synthetic.add_noise(
        points, 0, 0.01 * diagonal(points), seed=rng.integers(2**31)
    ),
    "Gaussian noise 1 %": lambda points, rng: noise(points, 0.01, rng),
    "noise 2 %": lambda points, rng: synthetic.add_noise(
        points, 0, 0.02 * diagonal(points), seed=rng.integers(2**31)
    ),
    "20 % missing, scattered": lambda points, rng: synthetic.remove_points(
        points, 0.2, seed=rng.integers(2**31)
    ),
    "20 % missing, one hole": lambda points, rng: points[hole(points, 0.2, rng)],
    "40 % missing, one hole": lambda points, rng: points[hole(points, 0.4, rng)],
    "density 10:1": lambda points, rng: points[falling_density(points, 10, rng)],
}


def _case(
    name: str, damage: str, subjects: tuple[str, ...], draw: Callable[[str, Rng], Draw]
) -> Case:
    bar = 1e-6 if damage == "clean" else 0.01

    def run(subject: str, rng: Rng) -> Figures:
        points, truth = draw(subject, rng)
        points = DAMAGES[damage](points, rng)
        result, seconds = timed_detect(points, "sphere")
        if result.mirror is None:
            return {"e_c": np.inf, "e_r": np.inf, "reported": 0.0, "seconds": seconds}
        mirrors = [result.mirror, *(other.mirror for other in result.candidates)]
        errors = [metrics.sphere_errors(mirror, truth, points) for mirror in mirrors]
        return {
            "e_c": errors[0].e_c,
            "e_r": errors[0].e_r,
            "reported": float(min(each.e_c for each in errors) <= bar),
            "seconds": seconds,
        }

    return Case(f"sphere, {name}, {damage}", subjects, run, {"e_c": at_most(bar)})


WIDE = tuple(f"{radius} diagonals" for radius in (3, 10, 30, 100))
SHAPES = ("relief", "bumpy")

CASES = (
    *(_case("thesis", damage, SURFACES, thesis) for damage in DAMAGES),
    _case("ten times the points", "noise 1 %", SURFACES, dense_thesis),
    _case("wide", "clean", WIDE, wide),
    *(_case("random shapes", damage, SHAPES, random_shape)
      for damage in ("clean", "noise 1 %", "20 % missing, one hole")),
)  # fmt: skip
