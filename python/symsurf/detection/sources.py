"""What ``detect_chunks`` takes, as arrays of points that come one after the other."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..base.options import Reading
from ..reading.in_chunks import ROWS, chunks_of
from ..shapes.objects import points_of


@dataclass(frozen=True)
class Source:
    """Chunks, as they were given."""

    start: Callable[[], Iterator[Any]]
    """Gives them from the first on."""
    count: int | None = None
    """How many points they hold in all, where that is known beforehand."""
    restarts: bool = True
    """Whether they can be had a second time."""

    def __iter__(self) -> Iterator[NDArray[np.float64]]:
        """A copy of each, (n, 3), as the next one may lie in the same memory."""
        for number, chunk in enumerate(self.start()):
            try:
                points = np.array(points_of(chunk), dtype=np.float64, order="C")
            except (TypeError, ValueError) as error:
                raise InvalidInput(
                    f"chunk {number} holds no rows of three numbers: {error}"
                ) from error
            if points.size == 0:
                points = np.empty((0, 3))
            if points.ndim != 2 or points.shape[1] != 3:
                raise InvalidInput(f"chunk {number} has shape {points.shape}; allowed is (n, 3)")
            yield points


def source_of(chunks: Any, reading: Reading) -> Source:
    """Of the name of a file or several, an array, a function without arguments, or an iterable."""
    if isinstance(chunks, Source):
        return chunks
    if _is_path(chunks):
        return _files([Path(chunks)], reading)
    if isinstance(chunks, (list, tuple)) and chunks and all(map(_is_path, chunks)):
        return _files([Path(name) for name in chunks], reading)
    if isinstance(chunks, np.ndarray):
        return Source(lambda: _slices(chunks), len(chunks) if chunks.ndim else None)
    if is_dask_array(chunks):
        return Source(lambda: (block.compute() for block in chunks.rechunk({1: -1}).blocks))
    if callable(chunks):
        return Source(lambda: iter(chunks()))
    if isinstance(chunks, Iterable):
        return Source(lambda: iter(chunks), restarts=not isinstance(chunks, Iterator))
    raise InvalidInput(
        f"chunks are of type {type(chunks).__name__}; allowed are arrays (n, 3) in an iterable or of a "
        "function, an array, the name of a file, or names of files"
    )


def is_dask_array(given: Any) -> bool:
    return hasattr(given, "rechunk")


def _is_path(given: Any) -> bool:
    return isinstance(given, (str, os.PathLike))


def _slices(array: NDArray[Any]) -> Iterator[NDArray[Any]]:
    return (array[begin : begin + ROWS] for begin in range(0, len(array), ROWS))


def _files(paths: list[Path], reading: Reading) -> Source:
    files = [chunks_of(path, reading) for path in paths]
    for path, file in zip(paths, files):
        if file.system != files[0].system:
            raise InvalidInput(
                f"{paths[0]} and {path} name different coordinate reference systems; allowed is one"
            )
    counts = [file.count for file in files]
    known = [count for count in counts if count is not None]
    return Source(
        lambda: (points for file in files for points in file.start()),
        sum(known) if len(known) == len(files) else None,
    )
