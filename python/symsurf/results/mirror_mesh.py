"""A result's mirror as triangles to save or draw."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from .result import Result

# Statistics that say that other points were searched than were given.
_SEARCHED = {"nonfinite_points", "outliers", "surface_samples"}


def mirror_mesh(
    result: Result, points: NDArray[np.float64] | None
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and triangles over the points, or over those that were searched where some were left
    out or added; none without a mirror, or for one that maps none of the points."""
    none = np.empty((0, 3)), np.empty((0, 3), np.int64)
    if result.mirror is None:
        return none
    if _SEARCHED & result.statistics.keys():
        with suppress(InvalidInput):  # a mirror that was matched knows no points
            return result.mirror.mesh()
    if points is not None:
        points = points[np.isfinite(points).all(axis=1)]
    with suppress(InvalidInput):
        return result.mirror.mesh(points)
    return none
