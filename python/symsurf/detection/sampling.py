"""Fewer points, and normals for points that have none."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..base.progress import Progress


def downsample(points: ArrayLike, count: int) -> NDArray[np.float64]:
    """Downsamples to evenly spread points (m, 3), at least ``count`` if the input has as many
    distinct ones.

    The simplification of Hruda et al. (2022): a grid of cells l_avg / k, l_avg being the mean
    distance from the centroid and k = 1, 2, 3, ... until ``count`` cells are occupied; the mean of
    each occupied cell. Raises InvalidInput for no points or NaN, InvalidParameter for a count
    below 1.
    """
    return _core.downsample(points, count)


def estimate_normals(
    points: ArrayLike,
    neighbours: int = 10,
    method: str = "pca",
    *,
    threads: int = 0,
    progress: Progress | None = None,
) -> NDArray[np.float64]:
    """Estimates unit normals (n, 3) from the ``neighbours`` nearest points, including the point
    itself.

    Args:
        points: (n, 3).
        neighbours: 3 or more.
        method: "pca", the direction of least variance; or "regression", z = b0 + b1 x + b2 y by
            least squares, which is poor on vertical patches.
        threads, progress: as for ``detect``.

    Raises:
        InvalidInput: fewer points than neighbours, or points that ``detect`` refuses.
        InvalidParameter: fewer than 3 neighbours, or an unknown method.
        Cancelled: the progress callback returned False.
    """
    return _core.estimate_normals(points, neighbours, method, threads, progress)
