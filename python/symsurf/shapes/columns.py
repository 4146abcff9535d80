"""Arrays of points as columns of a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from numpy.typing import NDArray


def columns_of(arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Arrays (n,) and (n, k) as columns (n,): of three those of x, y and z, else numbered from 0."""
    columns: dict[str, NDArray[Any]] = {}
    for name, values in arrays.items():
        if values.ndim == 1:
            columns[name] = values
        else:
            ends = "xyz" if values.shape[1] == 3 else range(values.shape[1])
            named = (f"{name}_{end}" for end in ends)
            columns |= dict(zip(named, values.T, strict=True))
    return columns
