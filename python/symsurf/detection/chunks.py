"""The mirror of more points than memory holds: one pass over them thins them, a second pairs them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, Mirror, PointSummary, SurfaceMatcher
from ..base.options import Reading
from ..base.progress import Progress, share
from ..reading.inputs import refuses
from ..results import Result
from . import detect
from .sources import source_of
from .summaries import CELLS, summarize

_READING = 0.9  # of the time: what is thinned takes a second


def detect_chunks(
    chunks: Any,
    method: str = "auto",
    *,
    cells: int = CELLS,
    communicator: Any = None,
    external_files: bool = False,
    nonfinite: str = "skip",
    seed: int = 0,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: Any,
) -> Result[Mirror]:
    """Finds the mirror of points that do not fit into memory, in one pass over chunks of them.

    The points are reduced to the means of at most ``cells`` cells of a grid (``PointSummary``), in
    which ``detect`` finds the mirror. The result is the same, to the bit, for
    any chunks of the same points in any order, and for any number of processes and threads.

    Args:
        chunks: arrays (n, 3), n >= 0, in an iterable or of a function without arguments; an array,
            such as one that NumPy maps; the name of a file, or names of files (LAS, NPY and binary PLY;
            with laspy LAZ and COPC, with pye57 E57, with PyVista PVTP and VTKHDF); an array of Dask,
            whose blocks its workers thin; or a ``PointSummary``.
        method: one of ``methods()``.
        cells: maximum number of cells, in [64, 2^28]; 120 bytes each.
        communicator: a communicator of mpi4py, or another object with ``allgather``: each process
            passes its own chunks and gets the result of all.
        external_files, nonfinite, seed, threads, progress: as for ``detect``.
        **parameters: parameters of the method, as for ``detect``.

    Returns:
        The result of ``detect`` for the reduced points, which are ``Result.points``: pairs are
        indices into them. ``statistics`` has "summarized_points", the number of points read,
        "nonfinite_points" in addition to these, "cells", and "cell_edge" of the grid, in input
        units.

    Raises:
        InvalidInput: a chunk of another shape, a coordinate beyond 1e50, a file that cannot be read in
            chunks, files that name different coordinate reference systems; else as ``detect`` does.
        InvalidParameter, Cancelled: as ``detect`` does.
    """

    refuse = refuses(nonfinite)
    summary = summarize(
        chunks,
        cells=cells,
        communicator=communicator,
        external_files=external_files,
        progress=share(progress, 0, _READING),
    )
    if refuse and summary.nonfinite:
        raise InvalidInput(f"{summary.nonfinite} points are not finite")
    finding = share(progress, _READING, 1)
    return detect(summary, method, seed=seed, threads=threads, progress=finding, **parameters)


class ChunkMatches(NamedTuple):
    """How the mirror fits the points of a chunk."""

    partners: NDArray[np.int64]
    """(n,) indices into the thinned points, of the nearest to the image; -1 where none is near."""
    residuals: NDArray[np.float64]
    """(n,) distances from the image to the surface about the partner, in input units; NaN without."""


def match_chunks(
    chunks: Any,
    result: Result,
    pair_distance: float = 0.05,
    *,
    external_files: bool = False,
    threads: int = 0,
) -> Iterator[ChunkMatches]:
    """Finds partners and residuals of all points over the mirror of ``detect_chunks``, in a second
    pass.

    Args:
        chunks: as for ``detect_chunks``, but for summaries; what can be had once alone, such as a
            generator, is an error. Blocks of Dask are computed one after the other.
        result: of ``detect_chunks``.
        pair_distance: maximum distance between image and partner, as a fraction of the diagonal of
            the downsampled points.
        external_files, threads: as for ``detect``.

    Yields:
        The partners and the residuals of a chunk.

    Raises:
        InvalidInput: a result without a mirror or without its points; other points than in the first
            pass, which is known, and raised, when all have been seen.
    """
    source = source_of(chunks, Reading(external_files=external_files))
    if not source.restarts:
        raise InvalidInput("the chunks can be had once alone; give a function that makes them")
    if result.mirror is None or result.points is None:
        raise InvalidInput("the result has no mirror, or no points")
    surface = np.asarray(result.points)
    matcher = SurfaceMatcher(surface, result.mirror)
    distance = pair_distance * float(np.linalg.norm(np.ptp(surface, axis=0)))
    again = PointSummary(result.statistics.get("cells", CELLS))
    for points in source:
        again.add(points)
        yield ChunkMatches(*matcher.match(points, distance, threads))
    count = again.count + again.nonfinite
    if count != result.point_count:
        raise InvalidInput(
            f"the chunks have changed: they held {result.point_count} points, and now {count}"
        )
    if "cells" in result.statistics and not np.array_equal(again.means, surface):
        raise InvalidInput("the chunks have changed: their points lie elsewhere")
