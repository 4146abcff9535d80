"""The data of the thesis's experiments, made anew. The text names the surfaces and the damage;
sizes, which it does not print, are chosen so that what it says of an experiment holds."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..detection.sampling import downsample
from ..synthetic import (
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

RESOLUTION = 32
MOST_NOISE = 0.3


class Experiment(NamedTuple):
    make: Callable[[], Sample]
    damage: Damage | None = None
    rotation: tuple[float, float, float] = (0, 0, 0)
    """About x, y and z, degrees."""


def experiment(table: str, method: str, name: str) -> Experiment:
    """The experiment of a table's row."""
    if table == "5.1":
        return Experiment(_FIXED[name])
    if table in ("5.2", "5.3"):
        return Experiment(_PERPENDICULAR[name])
    if table == "5.4":
        return Experiment(_SPHERICAL[name])
    if method.startswith("sphere"):
        return Experiment(_SPHERICAL["experiment 2"], _SPHERE_DAMAGES[name])
    make = _FIXED["experiment 1"] if method == "separation" else _PERPENDICULAR["experiment 1"]
    if name == "rotation":
        return Experiment(make, rotation=(10, 15, 20))
    return Experiment(make, _DAMAGES[name])


def _sheet(surface: str, extent: float = 2.0) -> Points:
    return Surface(surface).sample(extent, RESOLUTION)


def _step() -> Points:
    """Half of it above the mirrors it is used with, half below: no plane parts it from its image."""
    points = _sheet("f1")
    return points + np.where(points[:, :1] > 0, 1, -1) * np.array([0, 0, 2.5])


def _torus(large: float, small: float) -> Points:
    """A quarter of a step round the tube, so that no point stands above another."""
    step = 2 * np.pi / RESOLUTION
    angle = np.arange(RESOLUTION) * step
    u, v = (grid.ravel() for grid in np.meshgrid(angle, angle + step / 4, indexing="ij"))
    radius = large + small * np.cos(v)
    return np.column_stack([radius * np.cos(u), radius * np.sin(u), small * np.sin(v)])


def _fixed(points: Callable[[], Points], surface: str, shift: float) -> Callable[[], Sample]:
    return lambda: mirror_fixed(points(), surface, shift)


def _perpendicular(
    surface: str, least: float, most: float | None = None, waves: int = 0
) -> Callable[[], Sample]:
    extent = 1.0 if surface == "f6" else 2.0
    return lambda: mirror_perpendicular(surface, extent, RESOLUTION, least, most, waves)


def _spherical(points: Callable[[], Points], radius: float | None = None) -> Callable[[], Sample]:
    """Between the first point and the last, of a quarter of the diagonal where no radius is given."""

    def make() -> Sample:
        cloud = points()
        quarter = float(np.linalg.norm(np.ptp(cloud, axis=0))) / 4
        sphere = sphere_between(cloud[0], cloud[-1], radius or quarter)
        return mirror_spherical(cloud, sphere.centre, sphere.radius)

    return make


_FIXED = {
    "experiment 1": _fixed(lambda: _sheet("f5"), "f1", 4),
    "experiment 2": _fixed(lambda: _sheet("f1"), "f2", 4),
    "experiment 3": _fixed(lambda: _sheet("f5"), "f3", 6),
    "experiment 4": _fixed(lambda: _sheet("f1"), "f4", 4),
    "experiment 5": _fixed(_step, "f5", 0),
    "experiment 6": _fixed(lambda: _torus(0.6, 0.3), "f6", 3),
    "experiment 7": _fixed(lambda: _sheet("f1"), "f4", 1.2),
}
_PERPENDICULAR = {
    "experiment 1": _perpendicular("f1", 1),
    "experiment 2": _perpendicular("f1", 1, 1.5, 2),
    "experiment 3": _perpendicular("f5", 1, 2, 2),
    "experiment 4": _perpendicular("f1", 1, 1.5, 3),
    "experiment 5": _perpendicular("f6", 0.2),
    "experiment 6": _perpendicular("f2", 0.2),
}
_SPHERICAL = {
    "experiment 1": _spherical(lambda: _sheet("f6", 1.0), radius=1),
    "experiment 2": _spherical(lambda: _sheet("f1")),
    "experiment 3": _spherical(lambda: _sheet("f5")),
    "experiment 4": _spherical(lambda: _sheet("f2")),
    "experiment 5": _spherical(lambda: _sheet("f4")),
}

_UPPER_CORNER = (0.8, 0.8, 0), (9, 9, 9)
_RIGHT_HALF = (0, -9, -9), (9, 9, 9)


def _noise(points: Points) -> Points:
    return add_noise(points, 0, MOST_NOISE, seed=1)


def _uneven(points: Points) -> Points:
    return thin(points, 10, (0, 0, 1), seed=1)


def _noise_in_part(points: Points) -> Points:
    return add_noise(points, 0, MOST_NOISE, _RIGHT_HALF, seed=1)


def _middle(points: Points) -> Points:
    return (points.min(axis=0) + points.max(axis=0)) / 2


_DAMAGES: dict[str, Damage] = {
    "noise 1": _noise,
    "noise 2": _noise_in_part,
    "removed part": lambda points: remove_points(points, 1, _UPPER_CORNER),
    "uneven 1": _uneven,
    "uneven 2": lambda points: downsample(_uneven(points), len(points) // 4),
}
_SPHERE_DAMAGES: dict[str, Damage] = {
    "noise 1": _noise,
    "noise 2": lambda points: add_noise(
        points, 0, MOST_NOISE, (_middle(points), points.max(axis=0)), seed=1
    ),
    "removed part 1": lambda points: remove_points(
        points, 1, (_middle(points) + 0.2 * np.ptp(points, axis=0), points.max(axis=0))
    ),
    "removed part 2": lambda points: remove_points(
        points, 1, (_middle(points) * (1, 0, 0) - (0, 9, 9), (9, 9, 9))
    ),
    "uneven 1": lambda points: thin(points, 4, (1, 0, 0), seed=1),
    "uneven 2": lambda points: thin(points, 4, (0, 1, 0), seed=1),
}
