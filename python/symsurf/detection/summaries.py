"""Points of any number, thinned as they pass."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .._core import Cancelled, PointSummary
from ..base.options import Reading
from ..base.progress import Progress
from .sources import is_dask_array, source_of

if TYPE_CHECKING:
    from concurrent.futures import Future

CELLS = PointSummary().cells


def summarize(
    chunks: Any,
    *,
    cells: int = CELLS,
    communicator: Any = None,
    external_files: bool = False,
    progress: Progress | None = None,
) -> PointSummary:
    """Reduces points that do not fit into memory to the means of grid cells.

    Args:
        chunks, cells, communicator, external_files: as for ``detect_chunks``.
        progress: called with the fraction done, where the number of points is known beforehand, else
            with 0, after each chunk; returning False cancels.

    Raises what ``detect_chunks`` does.
    """
    reading = Reading(external_files=external_files)
    if communicator is None:
        return _thinned(chunks, cells, reading, progress)
    part: PointSummary | Exception
    try:
        part = _thinned(chunks, cells, reading, progress)
    except Exception as error:  # noqa: BLE001 - the other processes would wait for ever
        part = error
    whole = PointSummary(cells)
    for each in communicator.allgather(part):
        if isinstance(each, Exception):
            raise each
        whole.add(each)
    return whole


def _thinned(chunks: Any, cells: int, reading: Reading, progress: Progress | None) -> PointSummary:
    """The next chunk is read while one is added."""
    from concurrent.futures import ThreadPoolExecutor

    summary = summary_in(chunks, cells)
    if summary is not None:
        return summary
    source, summary = source_of(chunks, reading), PointSummary(cells)
    added: Future[None] | None = None
    with ThreadPoolExecutor(1) as worker:
        for points in source:
            if added is not None:
                added.result()
                _tell(progress, summary, source.count)
            added = worker.submit(summary.add, points)
        if added is not None:
            added.result()
    return summary


def _tell(progress: Progress | None, summary: PointSummary, count: int | None) -> None:
    fraction = (summary.count + summary.nonfinite) / count if count else 0.0
    if progress is not None and progress(min(fraction, 1.0)) is False:
        raise Cancelled("cancelled by the caller")


def summary_in(points: Any, cells: int = CELLS) -> PointSummary | None:
    """Of an array of Dask, or what is one already; None of all else."""
    if isinstance(points, PointSummary):
        return points
    if not is_dask_array(points):
        return None
    from .dask_chunks import summary_of

    return summary_of(points, cells)


def summary_statistics(summary: PointSummary) -> dict[str, Any]:
    """What the statistics of a result say of the points that were thinned."""
    statistics = {
        "summarized_points": summary.count,
        "cells": summary.cells,
        "cell_edge": summary.edge,
    }
    return statistics | ({"nonfinite_points": summary.nonfinite} if summary.nonfinite else {})
