"""Laser scans that are packed, by laspy: LAZ and COPC."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import laspy
import numpy as np
from numpy.typing import NDArray

from ...base.options import Reading
from .. import las
from . import ROWS, FileChunks, las_chunks


def chunks_of(path: Path, reading: Reading) -> FileChunks:
    *_, count, is_packed = las.layout(path)
    if not is_packed:
        return las_chunks.chunks_of(path, reading)

    def rows() -> Iterator[NDArray[np.float64]]:
        with laspy.open(path) as scan:
            for points in scan.chunk_iterator(ROWS):
                yield np.stack([points.x, points.y, points.z], axis=1).astype(np.float64)

    return FileChunks(count, rows, las.reference_system(path))
