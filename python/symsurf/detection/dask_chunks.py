"""Arrays of Dask: each worker thins its blocks, and summaries are merged in a tree."""

from __future__ import annotations

from typing import Any

import dask
import numpy as np

from .._core import InvalidInput, PointSummary

_BRANCHES = 8  # summaries that one task merges


def summary_of(array: Any, cells: int) -> PointSummary:
    """Raises InvalidInput for an array that is not (n, 3)."""
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"the array of Dask is {array.shape}; allowed is (n, 3)")
    blocks = array.rechunk({1: -1}).to_delayed().ravel()
    parts = [dask.delayed(_thinned)(block, cells) for block in blocks]
    while len(parts) > 1:
        parts = [
            dask.delayed(_merged)(parts[begin : begin + _BRANCHES], cells)
            for begin in range(0, len(parts), _BRANCHES)
        ]
    return dask.compute(*parts)[0]


def _thinned(block: Any, cells: int) -> PointSummary:
    summary = PointSummary(cells)
    summary.add(np.asarray(block, dtype=np.float64))
    return summary


def _merged(parts: list[PointSummary], cells: int) -> PointSummary:
    whole = PointSummary(cells)
    for part in parts:
        whole.add(part)
    return whole
