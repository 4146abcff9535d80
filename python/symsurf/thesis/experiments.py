"""The data of the thesis's experiments, made anew. The text names the surfaces and the damage;
sizes, which it does not print, are chosen so that what it says of an experiment holds."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..detection.sampling import downsample
from ..synthetic import (
    Box,
    Sample,
    Surface,
    add_noise,
    mirror_fixed,
    mirror_perpendicular,
    mirror_spherical,
    remove_points,
    sphere_between,
    thin,
)

Points = NDArray[np.float64]
Damage = Callable[[Points], Points]


class Experiment(NamedTuple):
    make: Callable[[], Sample] | Callable[[], Points]
    """Points alone are those of an object whose mirror is not known."""
    damage: Damage | None = None
    rotation: tuple[float, float, float] = (0, 0, 0)
    """About x, y and z, degrees."""


def experiment(table: str, method: str, name: str) -> Experiment:
    """The experiment of a table's row, or of a figure."""
    if table == "5.1":
        return Experiment(_FIXED[name])
    if table in ("5.2", "5.3", "5.8"):
        return Experiment(_PERPENDICULAR[name])
    if table == "5.4":
        return Experiment(_SPHERICAL[name])
    if table in _OBJECTS:
        return Experiment(_OBJECTS[table][name])
    if method.startswith("sphere"):
        return _SPHERE_DAMAGES[name]
    fixed = method == "separation"
    make = _FIXED["experiment 1"] if fixed else _PERPENDICULAR["experiment 1"]
    if name == "rotation":
        return Experiment(make, rotation=(25, -35, 40))
    if name.startswith("uneven"):
        make = (
            _fixed(lambda: _sheet("f1", count=60), "f1", 2)
            if fixed
            else _perpendicular("f1", 1, count=60)
        )
        return Experiment(make, _uneven if name == "uneven 1" else _downsampled)
    return Experiment(
        make,
        {
            "noise 1": _noise(0.5),
            "noise 2": _noise(0.5 if fixed else 1, _RIGHT_HALF),
            "removed part": _hole(0.7 if fixed else 0.9),
        }[name],
    )


def _sheet(surface: str, extent: float = 2.0, count: int = 30) -> Points:
    return Surface(surface).sample(extent, count)


def _torus(around: int, across: int) -> Points:
    """Of radii 1 and 0.4, a quarter of a step round the tube, so that no point stands above another."""
    angles = np.arange(around) / around, (np.arange(across) + 0.25) / across
    u, v = (2 * np.pi * grid.ravel() for grid in np.meshgrid(*angles, indexing="ij"))
    radius = 1 + 0.4 * np.cos(v)
    return np.column_stack([radius * np.cos(u), radius * np.sin(u), 0.4 * np.sin(v)])


def _directions(count: int) -> Points:
    """Even over the unit sphere (Fibonacci)."""
    step = np.arange(count) + 0.5
    z, turn = 1 - 2 * step / count, np.pi * (3 - np.sqrt(5)) * step
    radius = np.sqrt(1 - z**2)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), z])


def _ellipsoid() -> Points:
    return _directions(1500) * (1, 0.7, 0.5)


def _capsule() -> Points:
    points = _directions(1500) * (0.5, 0.5, 1)
    return points + np.sign(points[:, 2:]) * np.array([0, 0, 0.2])


def _blob() -> Points:
    unit = _directions(1200)
    x, y, z = unit.T
    bumps = 0.2 * np.sin(3 * x + 1) + 0.15 * np.cos(4 * y) + 0.15 * np.sin(3 * z + 2 * y)
    return unit * (1 + bumps)[:, None]


def _bent() -> Points:
    """A bar bent over a cylinder of radius 1."""
    x, y, z = (_directions(1500) * (0.3, 1.2, 0.3)).T
    return np.column_stack([(1 + x) * np.cos(y), (1 + x) * np.sin(y), z])


def _hemisphere(count: int, share: float) -> Points:
    """Of the unit sphere, over a disc of this radius, at random: as regular as others, its two sides
    would be separable."""
    rng = np.random.default_rng(1)
    radius, turn = share * np.sqrt(rng.random(count)), 2 * np.pi * rng.random(count)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.sqrt(1 - radius**2)])


def _fixed(points: Callable[[], Points], surface: str, shift: float) -> Callable[[], Sample]:
    return lambda: mirror_fixed(points(), surface, shift)


def _perpendicular(
    surface: str,
    least: float,
    most: float | None = None,
    waves: int = 0,
    extent: float = 2.0,
    count: int = 30,
) -> Callable[[], Sample]:
    return lambda: mirror_perpendicular(surface, extent, count, least, most, waves)


def _about_hemisphere(distance: float) -> Callable[[], Sample]:
    """On both sides of the hemisphere f6."""

    def make() -> Sample:
        feet = _hemisphere(1000, 0.99)
        count = np.arange(len(feet))
        return Sample(
            np.vstack([(1 + distance) * feet, (1 - distance) * feet]),
            mirror_perpendicular("f6", 1, 8, distance).truth,
            np.column_stack([count, count + len(feet)]),
        )

    return make


def _spherical(points: Callable[[], Points]) -> Callable[[], Sample]:
    """Over a sphere of a quarter of the diagonal that passes midway between two points and has 30 to
    80 % of all inside."""

    def make() -> Sample:
        cloud, rng = points(), np.random.default_rng(1)
        radius = float(np.linalg.norm(np.ptp(cloud, axis=0))) / 4
        while True:
            first, second = cloud[rng.choice(len(cloud), 2, replace=False)]
            sphere = sphere_between(first, second, radius)
            inside = np.linalg.norm(cloud - sphere.centre, axis=1) < radius
            if 0.3 <= inside.mean() <= 0.8:
                return mirror_spherical(cloud, sphere.centre, radius)

    return make


_FIXED = {
    "experiment 1": _fixed(lambda: _sheet("f2"), "f1", 3),
    "experiment 2": _fixed(lambda: _sheet("f1"), "f2", 4),
    "experiment 3": _fixed(lambda: _sheet("f1"), "f3", 6),
    "experiment 4": _fixed(lambda: _sheet("f1"), "f4", 5),
    "experiment 5": _fixed(lambda: _sheet("f1", 3), "f3", 1),
    "experiment 6": _fixed(lambda: _torus(30, 30), "f1", 2),
    "experiment 7": _fixed(lambda: _sheet("f1"), "f4", 0.5),
}
_PERPENDICULAR = {
    "experiment 1": _perpendicular("f1", 1),
    "experiment 2": _perpendicular("f1", 1, 1.5, 2),
    "experiment 3": _perpendicular("f1", 0.7, 1.7, 4, extent=3),
    "experiment 4": _perpendicular("f5", 0.5, 1.5, 1),
    "experiment 5": _about_hemisphere(0.7),
    "experiment 6": _perpendicular("f2", 0.2, extent=2.5, count=38),
}
_SPHERICAL = {
    "experiment 1": lambda: mirror_spherical(0.7 * _hemisphere(700, 0.95), (0, 0, 0), 1),
    "experiment 2": _spherical(_ellipsoid),
    "experiment 3": _spherical(_capsule),
    "experiment 4": _spherical(lambda: _torus(35, 20)),
    "experiment 5": _spherical(_blob),
}
_OBJECTS: dict[str, dict[str, Callable[[], Sample] | Callable[[], Points]]] = {
    "5.26": {
        "a": lambda: _directions(1500),
        "b": _bent,
        "c": lambda: _torus(30, 30),
        "d": _blob,
    },
    "5.27": {"a": _spherical(_blob), "b": _spherical(lambda: _torus(30, 30))},
}
FIGURES = {("5.8", "separation"): ["experiment 3"]} | {
    (figure, method): list(objects)
    for figure, objects in _OBJECTS.items()
    for method in ("separation", "separation_normals", "normals_only", "sphere_thesis")
}
"""What the thesis shows without numbers, by figure and method. Its objects are lost: others of their
kind stand for them."""

_RIGHT_HALF = (0, -9, -9), (9, 9, 9)


def _noise(most: float, box: Box | None = None) -> Damage:
    return lambda points: add_noise(points, 0, most, box, seed=1)


def _hole(half: float) -> Damage:
    """In the upper of two sheets."""
    return lambda points: remove_points(
        points, 1, ((-half, -half, _middle(points)[2]), (half, half, 9))
    )


def _uneven(points: Points) -> Points:
    return thin(points, 10, (0, 0, -1), seed=1)


def _downsampled(points: Points) -> Points:
    uneven = _uneven(points)
    return downsample(uneven, len(uneven) // 4)


def _middle(points: Points) -> Points:
    return (points.min(axis=0) + points.max(axis=0)) / 2


def _relative_noise(points: Points, is_half: bool = False) -> Points:
    """Up to 5 % of the diagonal, on half of the points or all."""
    most = 0.05 * float(np.linalg.norm(np.ptp(points, axis=0)))
    mean = float(points[:, 0].mean())
    return add_noise(points, 0, most, ((mean, -9, -9), (9, 9, 9)) if is_half else None, seed=1)


def _without_upper(share: float) -> Damage:
    """Without so much of the extent along x."""

    def damage(points: Points) -> Points:
        high = points[:, 0].max()
        return points[points[:, 0] <= high - share * np.ptp(points[:, 0])]

    return damage


_SPHERE_DAMAGES = {
    "noise 1": Experiment(_SPHERICAL["experiment 3"], _relative_noise),
    "noise 2": Experiment(_SPHERICAL["experiment 5"], lambda p: _relative_noise(p, True)),
    "removed part 1": Experiment(_SPHERICAL["experiment 2"], _without_upper(0.2)),
    "removed part 2": Experiment(_SPHERICAL["experiment 5"], _without_upper(0.5)),
    "uneven 1": Experiment(_SPHERICAL["experiment 2"], lambda p: thin(p, 1 / 0.3, (0, 0, -1), 1)),
    "uneven 2": Experiment(_SPHERICAL["experiment 3"], lambda p: thin(p, 1 / 0.3, (0, -1, 0), 1)),
}
