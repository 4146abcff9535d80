"""Laser scans: LAS, in place."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from ...base.options import Reading
from .. import las
from . import FileChunks, mapped_rows


def chunks_of(path: Path, reading: Reading) -> FileChunks:
    start, length, count, is_packed = las.layout(path)
    if is_packed:
        raise InvalidInput("its points are packed; as .laz they can be read")

    def rows() -> Iterator[NDArray[np.float64]]:
        for part in mapped_rows(path, np.dtype((np.uint8, (length,))), start, count):
            yield las.coordinates(path, part)

    return FileChunks(count, rows, las.reference_system(path))
