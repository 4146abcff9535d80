"""Arrays of NumPy, in place."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from ...base.options import Reading
from . import ROWS, FileChunks


def chunks_of(path: Path, reading: Reading) -> FileChunks:
    array = np.load(path, mmap_mode="r", allow_pickle=False)
    if not isinstance(array, np.ndarray):
        raise InvalidInput("it holds several arrays; allowed is one, as numpy.save writes it")
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "fiu":
        raise InvalidInput(
            f"the array is {array.shape} of {array.dtype}; allowed are numbers, (n, 3)"
        )
    count = len(array)

    def rows() -> Iterator[NDArray[np.float64]]:
        for begin in range(0, count, ROWS):
            # Opened anew: what was read of a mapping counts as memory of the process.
            mapped = np.load(path, mmap_mode="r", allow_pickle=False)
            yield np.array(mapped[begin : begin + ROWS], dtype=np.float64)

    return FileChunks(count, rows)
