"""Arrays of Dask: each worker thins its blocks, and summaries are merged in a tree."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import dask
import numpy as np

from .._core import InvalidInput, PointSummary

_BRANCHES = 8  # summaries that one task merges
_POINTS = (
    1 << 23
)  # that one task thins, of as many blocks: a summary has a quarter of a million cells


def summary_of(array: Any, cells: int) -> PointSummary:
    """Raises InvalidInput for an array that is not (n, 3)."""
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidInput(f"the array of Dask is {array.shape}; allowed is (n, 3)")
    array = array.rechunk({1: -1})
    blocks = array.to_delayed().ravel()
    parts = [dask.delayed(_thinned)(group, cells) for group in _groups(blocks, array.chunks[0])]
    while len(parts) > 1:
        parts = [
            dask.delayed(_merged)(parts[begin : begin + _BRANCHES], cells)
            for begin in range(0, len(parts), _BRANCHES)
        ]
    return dask.compute(*parts)[0]


def _groups(blocks: Any, sizes: Sequence[float]) -> list[list[Any]]:
    """Blocks that follow each other; each alone where nobody knows how many points it has."""
    groups: list[list[Any]] = []
    held = math.inf
    for block, size in zip(blocks, sizes):
        if not held + size <= _POINTS:
            groups.append([])
            held = 0
        groups[-1].append(block)
        held += size
    return groups


def _thinned(blocks: list[Any], cells: int) -> PointSummary:
    summary = PointSummary(cells)
    for block in blocks:
        summary.add(np.asarray(block, dtype=np.float64))
    return summary


def _merged(parts: list[PointSummary], cells: int) -> PointSummary:
    whole = PointSummary(cells)
    for part in parts:
        whole.add(part)
    return whole
