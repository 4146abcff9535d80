"""Landmarks and pairs as arrays, or an error that names what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput

_SHOWN = 5  # of many, the most that an error lists


def points_of(given: Any, may_be_flat: bool = False) -> NDArray[np.float64]:
    """(k, 3), or (k, 2) of flat ones, of an array, or of what has points. Raises InvalidInput."""
    points = numbers(getattr(given, "points", given), "points")
    if points.ndim != 2 or not (points.shape[1] == 3 or (may_be_flat and points.shape[1] == 2)):
        raise InvalidInput(f"points have shape {points.shape}; allowed is (k, 3)")
    return points


def numbers(given: Any, what: str) -> NDArray[np.float64]:
    """Raises InvalidInput for what cannot be read as real numbers."""
    try:
        return np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"{what} cannot be read as real numbers: {error}") from None


def indices_of(given: ArrayLike, count: int, what: str) -> NDArray[np.int64]:
    """Whole numbers from 0 to count - 1. Raises InvalidInput."""
    array = np.asarray(given)
    if array.size == 0:
        return array.astype(np.int64)
    if array.dtype.kind not in "iu":
        raise InvalidInput(f"{what} are of type {array.dtype}; allowed are whole numbers")
    outside = array[(array < 0) | (array >= count)]
    if outside.size:
        raise InvalidInput(
            f"{what} name landmark {outside.flat[0]}; allowed are 0 to {count - 1}, as there are "
            f"{count} landmarks"
        )
    return array.astype(np.int64)


def pairs_of(given: ArrayLike, count: int) -> NDArray[np.int64]:
    """(p, 2), each landmark in one pair. Raises InvalidInput."""
    pairs = indices_of(given, count, "pairs")
    if pairs.size == 0:
        return pairs.reshape(0, 2)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise InvalidInput(f"pairs have shape {pairs.shape}; allowed is (p, 2)")
    require_once(pairs.ravel(), "pairs")
    return pairs


def require_once(indices: NDArray[np.int64], what: str) -> None:
    values, times = np.unique(indices, return_counts=True)
    if (times > 1).any():
        raise InvalidInput(
            f"{what} name landmark {listed(values[times > 1])} twice; allowed is once"
        )


def listed(values: Iterable[Any]) -> str:
    """The first few, and how many more."""
    texts = [str(value) for value in values]
    more = f" and {len(texts) - _SHOWN} more" if len(texts) > _SHOWN else ""
    return ", ".join(texts[:_SHOWN]) + more
