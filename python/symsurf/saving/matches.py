"""How a mirror fits each point of chunks, in a file that is written while they pass."""

from __future__ import annotations

import os
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from ..detection.chunks import match_chunks
from ..results import Result
from .whole_files import write_whole

ROW = np.dtype([("partner", "<i8"), ("residual", "<f8")])


def save_matches(
    path: str | os.PathLike[str],
    chunks: Any,
    result: Result,
    pair_distance: float = 0.05,
    *,
    external_files: bool = False,
    threads: int = 0,
) -> None:
    """Writes the output of ``match_chunks`` to a NumPy file, one row per point: "partner" and
    "residual".

    ``numpy.load(path, mmap_mode="r")`` reads it in place. Little is in memory at any time, and the
    file is written whole or not at all.

    Args:
        path: of the file, usually ".npy".
        chunks, result, pair_distance, external_files, threads: as for ``match_chunks``.

    Raises what ``match_chunks`` does, and OSError.
    """

    def blocks() -> Iterator[bytes]:
        header = BytesIO()
        description = {"descr": ROW.descr, "fortran_order": False, "shape": (result.point_count,)}
        np.lib.format.write_array_header_1_0(header, description)
        yield header.getvalue()
        for matches in match_chunks(
            chunks, result, pair_distance, external_files=external_files, threads=threads
        ):
            rows = np.empty(len(matches.partners), ROW)
            rows["partner"], rows["residual"] = matches
            yield rows.tobytes()

    write_whole(Path(path), blocks())
