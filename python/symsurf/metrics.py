"""Errors of a result against a known mirror: those of the thesis, and two that need no frame."""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from . import _core
from ._core import InvalidParameter, Mirror, Sphere, SurfaceMirror
from .results import Result, mirror_of
from .synthetic import Surface


class _Errors(NamedTuple):
    rmse: float
    e_max: float
    e_avg: float


class SurfaceErrors(_Errors):
    """Errors along z in the surface's frame: (rmse, e_max, e_avg), thesis 5.1 to 5.3.

    e_avg is the mean absolute error; ``bias`` the signed one, which 5.2 prints. ``skipped`` points
    lie where the surface is undefined and are not ``counted``.
    """

    bias: float
    counted: int
    skipped: int


class SphereErrors(NamedTuple):
    """Over the diagonal of the object: thesis 5.4 and 5.5."""

    e_c: float
    e_r: float


def surface_errors(
    surface_points: ArrayLike, surface: str | Surface | SurfaceMirror
) -> SurfaceErrors:
    """Errors of points (m, 3) against z = f(x, y). Raises InvalidInput where none can be counted."""
    known = surface.name if isinstance(surface, Surface) else surface
    figures = _core.surface_errors(surface_points, known)
    errors = SurfaceErrors(figures["rmse"], figures["e_max"], figures["e_avg"])
    errors.bias = figures["bias"]
    errors.counted = figures["counted"]
    errors.skipped = figures["skipped"]
    return errors


def sphere_errors(
    found: Sphere | Result[Sphere], truth: Sphere | Result[Sphere], points: ArrayLike
) -> SphereErrors:
    """Distance of the centres and difference of the radii, over the diagonal of the points."""
    spheres = _sphere_of(found, "found"), _sphere_of(truth, "truth")
    return SphereErrors(*_core.sphere_errors(*spheres, points))


def _sphere_of(given: Sphere | Result[Sphere], argument: str) -> Sphere:
    mirror = mirror_of(given, argument)
    if not isinstance(mirror, Sphere):
        raise InvalidParameter(f"{argument} is a {mirror.kind}; allowed is a sphere")
    return mirror


def surface_distance(
    surface_points: ArrayLike, truth: Result | Mirror | str, points: ArrayLike
) -> float:
    """RMS distance of points (m, 3) from the true mirror, over the diagonal of the object's."""
    return _core.surface_distance(surface_points, mirror_of(truth, "truth"), points)


def coverage(
    surface_points: ArrayLike,
    truth: Result | Mirror | str,
    points: ArrayLike,
    tolerance: float | None = None,
) -> float:
    """Which share of the object's footprint on the true mirror the surface points cover.

    Of the feet of the object's points, those with a surface point nearer than ``tolerance``, above
    0, times the diagonal; by default three times the spacing of the feet. Raises InvalidParameter
    for another tolerance, InvalidInput for an object without feet.
    """
    if tolerance is None:
        tolerance = 0.0  # the core's word for it
    elif not tolerance > 0:
        raise InvalidParameter(f"tolerance is {tolerance}; allowed is (0, inf)")
    return _core.coverage(surface_points, mirror_of(truth, "truth"), points, tolerance)
