"""Which values of a mask or an image choose a point."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import InvalidInput, InvalidParameter


def above(values: NDArray[Any], threshold: float | None, kind: str) -> NDArray[np.bool_]:
    """Whether each value is above the threshold; of a mask, which holds two values, whether it is
    the greater one.

    Args:
        kind: of the image, for errors.

    Raises InvalidInput for an image without a threshold, or where none is above; InvalidParameter
    for a threshold that is no number.
    """
    if threshold is None:
        chosen = _mask(values, kind)
    else:
        if not _is_number(threshold):
            raise InvalidParameter(f"threshold is {threshold!r}; allowed is a number")
        chosen = values > threshold
    if not chosen.any():
        raise InvalidInput(
            f"no scalar of the {kind} is above threshold={threshold}; they end at {values.max()}"
            if values.size
            else f"the {kind} has no points"
        )
    return chosen


def _is_number(value: Any) -> bool:
    text = isinstance(value, (str, bytes))
    return not text and np.isscalar(value) and not np.isnan(value)


def _mask(values: NDArray[Any], kind: str) -> NDArray[np.bool_]:
    if values.dtype.kind == "b":
        return values
    if values.dtype.kind in "iu" and values.size:
        low, high = values.min(), values.max()
        if low != high and ((values == low) | (values == high)).all():
            return values == high
    raise InvalidInput(
        f"the {kind} is a regular grid, whose own symmetry is not asked for, and its scalars are no "
        f"mask of two values; give threshold=NUMBER to choose the points above it (they go from "
        f"{values.min()} to {values.max()})"
        if values.size
        else f"the {kind} has no points"
    )
