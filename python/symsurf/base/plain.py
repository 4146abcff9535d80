"""Values in what JSON knows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray


def plain(value: Any) -> Any:
    """Arrays as lists, what is not finite as None."""
    if isinstance(value, dict):
        return {name: plain(item) for name, item in value.items()}
    if isinstance(value, np.ndarray):
        finite = value.dtype.kind != "f" or np.isfinite(value).all()
        return value.tolist() if finite else plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def without_rounding(numbers: Any) -> NDArray[Any]:
    """As an array, with 0 for what is a rounding error of the largest."""
    values = np.asarray(numbers)
    if values.dtype.kind != "f":
        return values
    size = np.abs(values)
    return np.where(size < 1e-12 * np.nanmax(size, initial=0.0), 0.0, values)


def shown(value: Any, digits: str = "g") -> str:
    """The value as on the command line; of a table only its size."""
    if isinstance(value, bool):
        return str(value).lower()
    if value is None:  # in a record, what is no number
        return "nan"
    if isinstance(value, (list, np.ndarray)):
        if np.ndim(value) > 1:
            return f"{len(value)} x {len(value[0])} numbers"
        return ",".join(shown(number, digits) for number in without_rounding(value).tolist())
    return format(value, digits) if isinstance(value, float) else str(value)
