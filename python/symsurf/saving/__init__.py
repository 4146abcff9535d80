"""Writing results to files, each format in its own module."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from .._core import InvalidParameter, Operation, operations
from ..results import AnalysisResult, Correspondences, OperationResult, Result
from ..results.outputs import save
from .json_format import analysis_bytes, json_bytes, operation_bytes
from .ply_format import ply_bytes, shape_ply_bytes
from .same_format import shape_bytes
from .table_format import csv_bytes, mirror_bytes, npy_bytes
from .text_format import text_bytes
from .vtp_format import shape_vtp_bytes, vtp_bytes

FORMATS = {".json": json_bytes, ".vtp": vtp_bytes, ".ply": ply_bytes, ".txt": text_bytes}
BARE_FORMATS = (".obj", ".off", ".stl")
"""Of shapes without arrays."""


def shape_formats(operation: Operation) -> list[str]:
    """Those of what it makes: what gives nothing but arrays is in none without them."""
    return [".ply", ".vtp", *(BARE_FORMATS if makes_shape(operation) else ())]


def makes_shape(operation: Operation) -> bool:
    """Whether there is more than arrays of the points that are given."""
    return operation.moves_points or operation.adds_points or operation.carries_values


def _face_arrays(result: OperationResult | AnalysisResult) -> dict[str, Any]:
    return result.face_arrays if isinstance(result, OperationResult) else {}


def _bare_bytes(suffix: str, result: OperationResult) -> bytes:
    if suffix == ".stl" and result.shape.faces is None:
        raise InvalidParameter(
            "STL holds triangles, and the shape has none; allowed is another suffix"
        )
    return shape_bytes(result.shape, suffix)


_WITH_ARRAYS: dict[str, Callable[[OperationResult | AnalysisResult], bytes]] = {
    ".ply": lambda result: shape_ply_bytes(result.shape, result.arrays, _face_arrays(result)),
    ".vtp": lambda result: shape_vtp_bytes(result.shape, result.arrays, _face_arrays(result)),
    ".csv": lambda result: csv_bytes(result.arrays),
    ".npy": lambda result: npy_bytes(result.arrays),
}
OPERATION_FORMATS: dict[str, Callable[[OperationResult], bytes]] = {
    **_WITH_ARRAYS,
    **{suffix: partial(_bare_bytes, suffix) for suffix in BARE_FORMATS},
    ".json": operation_bytes,
}
CORRESPONDENCES_FORMATS = {**OPERATION_FORMATS, ".mirror": mirror_bytes}
ANALYSIS_FORMATS: dict[str, Callable[[AnalysisResult], bytes]] = {
    **_WITH_ARRAYS,
    ".json": analysis_bytes,
}


def _save(
    formats: Mapping[str, Callable[[Any], bytes]], result: Any, path: str | os.PathLike[str]
) -> None:
    """Writes a result in the format of the path's suffix."""
    path = Path(path)
    suffix = path.suffix.lower()
    if isinstance(result, OperationResult) and not makes_shape(operations()[result.operation]):
        formats = {name: made for name, made in formats.items() if name not in BARE_FORMATS}
    if suffix not in formats:
        raise InvalidParameter(
            f"path is {str(path)!r}; allowed are the suffixes {', '.join(formats)}"
        )
    if isinstance(result, AnalysisResult) and not result.arrays and suffix in (".csv", ".npy"):
        raise InvalidParameter(
            f"path is {str(path)!r}; {result.analysis} gives no arrays: allowed are the other suffixes"
        )
    write_whole(path, formats[suffix](result))


save.register(Result, partial(_save, FORMATS))
save.register(OperationResult, partial(_save, OPERATION_FORMATS))
save.register(Correspondences, partial(_save, CORRESPONDENCES_FORMATS))
save.register(AnalysisResult, partial(_save, ANALYSIS_FORMATS))


def write_whole(path: Path, content: bytes | Iterable[bytes]) -> None:
    """Writes the file whole or not at all: what stood there stays until the new one is complete.
    Blocks are written as they come."""
    file = path.resolve()  # a link stays a link
    if file.exists() and not file.is_file():  # such as a device, which a file would replace
        raise OSError(errno.EINVAL, "This is not a file", str(path))
    # A name of its own: others may write the same file at the same time.
    unfinished = file.with_name(f".symsurf-{os.urandom(8).hex()}.partial")
    before = file.stat() if file.exists() else None
    opener = partial(os.open, mode=0o666 if before is None else 0o600)
    try:
        with open(unfinished, "xb", opener=opener) as new:
            if before is not None:
                _hand_over(unfinished, before)
            new.writelines([content] if isinstance(content, bytes) else content)
        unfinished.replace(file)
    except BaseException as error:
        with suppress(OSError):
            unfinished.unlink()
        if isinstance(error, OSError):  # which names the partial file
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise


def _hand_over(file: Path, before: os.stat_result) -> None:
    """To those who may read and write what stood there."""
    with suppress(OSError, AttributeError):  # root may give files away; Windows has no owners
        os.chown(file, before.st_uid, before.st_gid)
    file.chmod(stat.S_IMODE(before.st_mode))
