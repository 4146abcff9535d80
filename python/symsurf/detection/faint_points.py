"""Points that count less than others: a share of them takes part."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput
from ..reading.inputs import require_finite

_GOLDEN = (np.sqrt(5) - 1) / 2  # its multiples fill [0, 1) evenly, of any stretch of numbers


def without_faint(points: Any, weights: ArrayLike, refuse: bool) -> tuple[NDArray[np.float64], int]:
    """The points with NaN in place of those that do not take part, and how many these are.

    Raises InvalidInput unless there is one weight in [0, 1] per point; with ``refuse`` for points
    that are not finite.
    """
    given, shares = np.asarray(points, dtype=float), np.asarray(weights, dtype=float)
    if shares.shape != given.shape[:1] or not ((shares >= 0) & (shares <= 1)).all():
        raise InvalidInput(
            f"weights have shape {shares.shape}; allowed is one number in [0, 1] per point: "
            f"({len(given)},)"
        )
    if refuse:
        require_finite(given)
    faint = np.arange(len(given)) * _GOLDEN % 1 >= shares
    faint &= np.isfinite(given).all(axis=1)
    return np.where(faint[:, None], np.nan, given), int(np.count_nonzero(faint))


def faint_statistics(statistics: dict[str, Any], faint: int) -> dict[str, Any]:
    """ "faint_points", and "nonfinite_points" without them."""
    return {
        "nonfinite_points": statistics["nonfinite_points"] - faint,
        "faint_points": faint,
    }
