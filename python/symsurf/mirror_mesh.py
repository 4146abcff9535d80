"""A result's mirror as triangles to save or draw."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from ._core import InvalidInput
from .result import Result


def mirror_mesh(
    result: Result, points: NDArray[np.float64] | None
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and triangles over the points, or over those that were searched where strays were
    left out; none without a mirror, or for one that maps none of the points."""
    if result.mirror is not None:
        with suppress(InvalidInput):
            return result.mirror.mesh(None if "stray_points" in result.statistics else points)
    return np.empty((0, 3)), np.empty((0, 3), np.int64)
