"""Laser scans: E57 by pye57, a scan at a time, in the file's common axes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pye57
from numpy.typing import NDArray

from ...base.options import Reading
from ...base.own_process import one_more_file
from . import FileChunks


def chunks_of(path: Path, reading: Reading) -> FileChunks:
    # The XML in it may name other files and hosts.
    with one_more_file(), pye57.E57(str(path)) as file:
        count = sum(file.get_header(scan).point_count for scan in range(file.scan_count))

    def scans() -> Iterator[NDArray[np.float64]]:
        with one_more_file(), pye57.E57(str(path)) as file:
            for scan in range(file.scan_count):
                read = file.read_scan(scan, ignore_missing_fields=True, transform=True)
                yield np.stack([read[f"cartesian{axis}"] for axis in "XYZ"], axis=1)

    return FileChunks(count, scans)
