"""Writing results to files, each format in its own module."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from secrets import token_hex
from typing import TYPE_CHECKING

from .._core import InvalidParameter
from ..result import Result
from .json_format import analysis_bytes, json_bytes, operation_bytes
from .ply_format import ply_bytes, shape_ply_bytes
from .table_format import csv_bytes, npy_bytes
from .text_format import text_bytes
from .vtp_format import shape_vtp_bytes, vtp_bytes

if TYPE_CHECKING:
    from ..mirror_operations import OperationResult
    from ..shape_analyses import AnalysisResult

FORMATS = {".json": json_bytes, ".vtp": vtp_bytes, ".ply": ply_bytes, ".txt": text_bytes}
SHAPE_FORMATS = {".ply": shape_ply_bytes, ".vtp": shape_vtp_bytes}
_WITH_ARRAYS: dict[str, Callable[[OperationResult | AnalysisResult], bytes]] = {
    ".ply": lambda result: shape_ply_bytes(result.shape, result.arrays),
    ".vtp": lambda result: shape_vtp_bytes(result.shape, result.arrays),
    ".csv": lambda result: csv_bytes(result.arrays),
    ".npy": lambda result: npy_bytes(result.arrays),
}
OPERATION_FORMATS: dict[str, Callable[[OperationResult], bytes]] = {
    **_WITH_ARRAYS,
    ".json": operation_bytes,
}
ANALYSIS_FORMATS: dict[str, Callable[[AnalysisResult], bytes]] = {
    **_WITH_ARRAYS,
    ".json": analysis_bytes,
}


def save(result: Result, path: str | os.PathLike[str]) -> None:
    """Writes the result in the format of the path's suffix; see ``Result.save``."""
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise InvalidParameter(
            f"path is {str(path)!r}; allowed are the suffixes {', '.join(FORMATS)}"
        )
    write_whole(path, FORMATS[path.suffix.lower()](result))


def write_whole(path: Path, content: bytes) -> None:
    """Writes the file whole or not at all: what stood there stays until the new one is complete."""
    file = path.resolve()  # a link stays a link
    if file.exists() and not file.is_file():  # such as a device, which a file would replace
        raise OSError(errno.EINVAL, "This is not a file", str(path))
    # A name of its own: others may write the same file at the same time.
    partial = file.with_name(f".symsurf-{token_hex(8)}.partial")
    try:
        with partial.open("xb") as new:
            new.write(content)
        partial.replace(file)
    except BaseException as error:
        with suppress(OSError):
            partial.unlink()
        if isinstance(error, OSError):  # which names the partial file
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise
