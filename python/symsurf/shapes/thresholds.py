"""Which values of a mask or an image choose a point."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, InvalidParameter
from ..base.options import Reading


def chosen_by(values: NDArray[Any], reading: Reading, kind: str) -> NDArray[np.bool_]:
    """Whether each value has the label or is above the threshold; of a mask, which holds two values,
    whether it is the greater one.

    Args:
        kind: of the image, for errors.

    Raises InvalidInput for an image without a threshold and a label, or where there is none such;
    InvalidParameter for a threshold or a label that is no number, and for both.
    """
    threshold = reading.threshold
    if reading.label is not None:
        return _labelled(values, reading, kind)
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


def _labelled(values: NDArray[Any], reading: Reading, kind: str) -> NDArray[np.bool_]:
    label = reading.label
    if reading.threshold is not None:
        raise InvalidParameter(f"label is {label!r} beside a threshold; allowed is one of them")
    if isinstance(label, str) or not _is_number(label):
        raise InvalidParameter(
            f"label is {label!r}; allowed is a number, and of a file with named segments a name"
        )
    chosen = values == label
    if not chosen.any():
        labels = np.unique(values)
        shown = ", ".join(map(str, labels[:20].tolist())) + ("" if len(labels) <= 20 else ", ...")
        raise InvalidInput(f"no scalar of the {kind} is label={label}; there are {shown}")
    return chosen


def _is_number(value: Any) -> bool:
    text = isinstance(value, (str, bytes))
    return not text and np.isscalar(value) and not np.isnan(value)


def _mask(values: NDArray[Any], kind: str) -> NDArray[np.bool_]:
    if values.dtype.kind == "b":
        return values
    if values.size:
        low, high = values.min(), values.max()
        is_whole = low == np.floor(low) and high == np.floor(high)
        if is_whole and low != high and ((values == low) | (values == high)).all():
            return values == high
    raise InvalidInput(
        f"the {kind} is a regular grid, whose own symmetry is not asked for, and its scalars are no "
        f"mask of two values; give threshold=NUMBER to choose the points above it, or label=NUMBER (they go from "
        f"{values.min()} to {values.max()})"
        if values.size
        else f"the {kind} has no points"
    )
