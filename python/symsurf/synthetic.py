"""Point sets with a known mirror, and damage to them: the thesis's experiments.

>>> from symsurf import synthetic
>>> sample = synthetic.mirror_perpendicular("f1", extent=2, resolution=40, min_distance=0.5)
>>> damaged = synthetic.add_noise(sample.points, 0, 0.1, seed=1)

A seed gives the same numbers on every machine.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._core import Mirror, Sphere
from .benchmark import BenchmarkSample, benchmark  # noqa: F401  # a part of this module for users

Box = tuple[ArrayLike, ArrayLike]
"""The lowest and the highest corner (3,) of an axis-aligned box; both are inside."""

SURFACES: tuple[str, ...] = tuple(_core.surface_names())


class Surface:
    """One of the thesis's functions f1 to f6, as z = f(x, y)."""

    def __init__(self, name: str) -> None:
        self.formula: str = _core.surface_formula(name)
        self.name = name

    def __call__(self, x: ArrayLike, y: ArrayLike) -> Any:
        """Heights, in the common shape of x and y; NaN where f is undefined."""
        return _core.surface_height(self.name, x, y)

    def gradient(self, x: ArrayLike, y: ArrayLike) -> tuple[Any, Any]:
        """(df/dx, df/dy); 0 across creases, not finite where f is undefined or vertical."""
        return _core.surface_gradient(self.name, x, y)

    def sample(self, extent: float, resolution: int) -> NDArray[np.float64]:
        """Points (n, 3) over a grid of x and y from -extent to extent, where f is defined."""
        return _core.sampled_surface(self.name, extent, resolution)

    def __repr__(self) -> str:
        return f"Surface({self.name}: {self.formula})"


class Sample(NamedTuple):
    """Points made to have a known mirror: P, then their images P'."""

    points: NDArray[np.float64]
    """(n, 3)"""
    truth: Mirror
    """The mirror they were made with."""
    pairs: NDArray[np.int64]
    """(n / 2, 2): the row of a point, the row of its image."""
    skipped: int = 0
    """Points left out: f is undefined there, or they lie outside the sphere."""


def surface(name: str) -> Surface:
    """The function "f1" ... "f6". Raises InvalidParameter for another name."""
    return Surface(name)


def _name(surface: str | Surface) -> str:
    return surface.name if isinstance(surface, Surface) else surface


def mirror_fixed(
    points: ArrayLike,
    surface: str | Surface,
    shift: float = 0.0,
    direction: ArrayLike = (0, 0, 1),
) -> Sample:
    """Thesis 5.1.1: points (n, 3) moved by ``shift`` along the direction, and their images.

    The images lie along the direction over the graph of the surface, whose z axis is turned to it.
    """
    return Sample(*_core.mirror_fixed(points, _name(surface), shift, direction))


def mirror_perpendicular(
    surface: str | Surface,
    extent: float,
    resolution: int,
    min_distance: float,
    max_distance: float | None = None,
    waves: int = 0,
) -> Sample:
    """Thesis 5.1.2: samples of the surface moved along its normal to either side.

    The samples lie over a grid, x and y from -extent to extent. The distance goes from the least
    to the greatest and back in ``waves`` legs along x; without waves it is ``min_distance``.
    """
    greatest = math.nan if max_distance is None else max_distance
    return Sample(
        *_core.mirror_perpendicular(
            _name(surface), extent, resolution, min_distance, greatest, waves
        )
    )


def mirror_spherical(points: ArrayLike, centre: ArrayLike, radius: float) -> Sample:
    """Thesis 5.1.3: the points (n, 3) inside the sphere, and their images over it."""
    return Sample(*_core.mirror_spherical(points, centre, radius))


def sphere_between(first: ArrayLike, second: ArrayLike, radius: float) -> Sphere:
    """The sphere midway between two points, its centre on their line on the first one's side."""
    return _core.sphere_between(first, second, radius)


def add_noise(
    points: ArrayLike, low: float, high: float, box: Box | None = None, seed: int = 0
) -> NDArray[np.float64]:
    """Moves the points in the box in random directions by distances uniform in [low, high]."""
    return _core.add_noise(points, low, high, box, seed)


def remove_points(
    points: ArrayLike, probability: float, box: Box | None = None, seed: int = 0
) -> NDArray[np.float64]:
    """Removes each point in the box with a probability in [0, 1]."""
    return _core.remove_points(points, probability, box, seed)


def rotate(points: ArrayLike, roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
    """Turns about the origin by degrees, about x, then y, then z.

    The thesis's manual calls the turn about y yaw and that about z pitch.
    """
    return _core.rotate(points, roll, pitch, yaw)


def rotation_matrix(roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
    """The rotation (3, 3) that ``rotate`` applies."""
    return _core.rotation_matrix(roll, pitch, yaw)


def thin(
    points: ArrayLike, ratio: float = 10.0, direction: ArrayLike = (1, 0, 0), seed: int = 0
) -> NDArray[np.float64]:
    """Uneven density: keeps one in ``ratio`` of the points in that half of the bounding box."""
    return _core.thin(points, ratio, direction, seed)
