"""How often and how exactly method "sphere" finds the sphere of the thesis's spherical data.

    build/venv/bin/python tests/benchmarks/sphere_accuracy.py [SEEDS] [--hard]

Surfaces of the thesis are mirrored over a sphere that a seed draws, in a pose that it draws, and
damaged. A line each: the share of trials with e_c within the bar, the share where the true sphere
is the one found or among the candidates, the median and the worst of e_c, the median of e_r.
--hard adds heavier damage, and shapes that no generator makes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import metrics, synthetic

Array = NDArray[np.float64]
SURFACES = "f6", "f1", "f5", "f4", "f3"
CLEAN, DAMAGED = 1e-6, 1e-2  # the bars on e_c
LEAST_POINTS = 400


class Trial(NamedTuple):
    points: Array
    truth: symsurf.Sphere


def diagonal(points: Array) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def thesis_trial(surface: str, seed: int, resolution: int = 32) -> Trial:
    """5.1.3: a sphere between two vertices, of a radius about a quarter of the diagonal."""
    rng = np.random.default_rng([seed, SURFACES.index(surface)])
    cloud = synthetic.surface(surface).sample(1.0 if surface == "f6" else 2.0, resolution)
    return _mirrored(cloud, rng, LEAST_POINTS * (resolution / 32) ** 2)


def _mirrored(cloud: Array, rng: np.random.Generator, least_points: float) -> Trial:
    while True:
        first, second = cloud[rng.choice(len(cloud), 2, replace=False)]
        radius = diagonal(cloud) / rng.uniform(2.5, 4.5)
        sphere = synthetic.sphere_between(first, second, radius)
        inside = np.linalg.norm(cloud - sphere.centre, axis=1) < radius
        if 2 * inside.sum() >= least_points:
            return _posed(cloud, sphere, rng)


def _posed(cloud: Array, sphere: symsurf.Sphere, rng: np.random.Generator) -> Trial:
    sample = synthetic.mirror_spherical(cloud, sphere.centre, sphere.radius)
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    scale, shift = 10 ** rng.uniform(-2, 2), rng.normal(size=3)
    order = rng.permutation(len(sample.points))
    points = scale * (sample.points @ rotation.T + shift)[order]
    centre = scale * (rotation @ sphere.centre + shift)
    return Trial(points, symsurf.Sphere(centre, scale * sphere.radius))


def blob_trial(seed: int, count: int = 1500) -> Trial:
    """A closed bumpy shape with the sphere through it."""
    rng = np.random.default_rng([seed, 100])
    u = rng.normal(size=(count, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    waves = rng.normal(size=(3, 3)) * 2
    radius = 1 + 0.15 * np.sin(u @ waves.T + rng.uniform(0, 6, 3)).sum(axis=1)
    cloud = u * radius[:, None] * (1.3, 1, 0.8)
    size = diagonal(cloud) * rng.uniform(0.5, 1)
    away = rng.normal(size=3)
    sphere = symsurf.Sphere(0.8 * size * away / np.linalg.norm(away), size)
    return _posed(cloud, sphere, rng)


def relief_trial(seed: int, count: int = 1500) -> Trial:
    """A random relief, sampled at random."""
    rng = np.random.default_rng([seed, 101])
    xy = rng.uniform(-2, 2, (count, 2))
    waves, phases = rng.normal(size=(4, 2)), rng.uniform(0, 6, 4)
    z = 0.3 * np.sin(xy @ waves.T + phases).sum(axis=1)
    return _mirrored(np.column_stack([xy, z]), rng, LEAST_POINTS)


def wide_trial(seed: int, diagonals: float, count: int = 1500) -> Trial:
    """A random relief and its image in a sphere so large that it is nearly a plane."""
    rng = np.random.default_rng([seed, 102])
    xy = rng.uniform(-0.5, 0.5, (count, 2))
    waves, phases = rng.normal(size=(4, 2)) * 4, rng.uniform(0, 6, 4)
    z = -0.35 - 0.05 * np.sin(xy @ waves.T + phases).sum(axis=1)
    cloud = np.column_stack([xy, z])
    radius = diagonals * diagonal(np.vstack([cloud, cloud * (1, 1, -1)]))
    return _posed(cloud, symsurf.Sphere((0, 0, -radius), radius), rng)


Damage = Callable[[Array, np.random.Generator], Array]


def noise(share: float) -> Damage:
    """Random directions, distances uniform up to a share of the diagonal (thesis 5.3)."""

    def damaged(points: Array, rng: np.random.Generator) -> Array:
        return synthetic.add_noise(points, 0, share * diagonal(points), seed=rng.integers(2**31))

    return damaged


def gaussian(share: float) -> Damage:
    return lambda points, rng: (
        points + share * diagonal(points) * rng.normal(size=points.shape) / np.sqrt(3)
    )


def hole(share: float) -> Damage:
    """The points around one of them go."""

    def damaged(points: Array, rng: np.random.Generator) -> Array:
        distance = np.linalg.norm(points - points[rng.integers(len(points))], axis=1)
        return points[np.argsort(distance)[int(share * len(points)) :]]

    return damaged


def scattered(share: float) -> Damage:
    return lambda points, rng: synthetic.remove_points(points, share, seed=rng.integers(2**31))


def uneven(ratio: float) -> Damage:
    return lambda points, rng: synthetic.thin(
        points, ratio, rng.normal(size=3), seed=rng.integers(2**31)
    )


def none(points: Array, rng: np.random.Generator) -> Array:
    return points


def errors(found: symsurf.Sphere, trial: Trial, points: Array) -> metrics.SphereErrors:
    return metrics.sphere_errors(found, trial.truth, points)


def report(name: str, trials: Iterator[Trial], damage: Damage, bar: float) -> None:
    e_c, e_r, there = [], [], []
    for number, trial in enumerate(trials):
        points = damage(trial.points, np.random.default_rng(number))
        result = symsurf.detect_sphere(points)
        best = errors(result.mirror, trial, points)
        e_c.append(best.e_c)
        e_r.append(best.e_r)
        mirrors = [result.mirror, *(other.mirror for other in result.candidates)]
        there.append(min(errors(mirror, trial, points).e_c for mirror in mirrors) <= bar)
    found = np.array(e_c) <= bar
    print(
        f"{name:32} {len(found):3} trials, e_c <= {bar:g}: {found.mean():6.1%},"
        f" true sphere reported: {np.mean(there):6.1%},"
        f" e_c median {np.median(e_c):.1e} worst {np.max(e_c):.1e},"
        f" e_r median {np.median(e_r):.1e}",
        flush=True,
    )


def main(seeds: int, hard: bool) -> None:
    def thesis() -> Iterator[Trial]:
        return (thesis_trial(surface, seed) for seed in range(seeds) for surface in SURFACES)

    report("clean", thesis(), none, CLEAN)
    report("noise 1 %", thesis(), noise(0.01), DAMAGED)
    report("20 % missing, scattered", thesis(), scattered(0.2), DAMAGED)
    report("20 % missing, one hole", thesis(), hole(0.2), DAMAGED)
    for diagonals in (3, 10, 30, 100):
        wide = (wide_trial(seed, diagonals) for seed in range(seeds))
        report(f"of {diagonals} diagonals, clean", wide, none, CLEAN)
    if not hard:
        return
    report("noise 1 %, Gaussian", thesis(), gaussian(0.01), DAMAGED)
    report("noise 2 %", thesis(), noise(0.02), DAMAGED)
    report("40 % missing, one hole", thesis(), hole(0.4), DAMAGED)
    report("density 10 : 1", thesis(), uneven(10), DAMAGED)
    fine = (thesis_trial(surface, seed, 100) for seed in range(seeds) for surface in SURFACES)
    report("ten times the points, noise 1 %", fine, noise(0.01), DAMAGED)
    shapes = {"blobs": blob_trial, "reliefs": relief_trial}
    for name, make in shapes.items():
        for damage_name, damage, bar in (
            ("clean", none, CLEAN),
            ("noise 1 %", noise(0.01), DAMAGED),
            ("20 % missing, one hole", hole(0.2), DAMAGED),
        ):
            report(f"{name}, {damage_name}", map(make, range(5 * seeds)), damage, bar)


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:] if word.isdigit()]
    main(*(numbers or [8]), "--hard" in sys.argv)
