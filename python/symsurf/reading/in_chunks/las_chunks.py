"""Laser scans: LAS, in place."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from .. import las
from . import ROWS, FileChunks


def chunks_of(path: Path) -> FileChunks:
    start, length, count, is_packed = las.layout(path)
    if is_packed:
        raise InvalidInput("its points are packed; as .laz they can be read")

    def rows() -> Iterator[NDArray[np.float64]]:
        for begin in range(0, count, ROWS):
            size = min(ROWS, count - begin)
            # Mapped anew: what was read of a mapping counts as memory of the process.
            content = np.memmap(path, np.uint8, "r", start + begin * length, (size, length))
            yield las.coordinates(path, content)

    return FileChunks(count, rows, las.reference_system(path))
