"""Writing results to files, each format in its own module."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path

from .._core import InvalidInput
from ..results import AnalysisResult, OperationResult, Result
from ..results.mirror_mesh import mirror_mesh
from ..results.outputs import save
from ..shapes import Shape
from .json_format import json_bytes
from .ply_format import ply_bytes
from .shape_files import SHAPES, require_format, save_shape
from .text_format import text_bytes
from .vtp_format import vtp_bytes
from .whole_files import write_whole

__all__ = ["FORMATS", "save_shape", "write_whole"]


def _mirror_bytes(suffix: str, result: Result) -> bytes:
    shape = Shape(*mirror_mesh(result, result.points), space=result.space)
    if shape.faces is None or not len(shape.faces):
        raise InvalidInput(f"there is no mirror to write as {suffix[1:].upper()}")
    return SHAPES[suffix](shape, {}, {})


FORMATS: dict[str, Callable[[Result], bytes]] = {
    ".json": json_bytes,
    ".vtp": vtp_bytes,
    ".ply": ply_bytes,
    ".txt": text_bytes,
    **{suffix: partial(_mirror_bytes, suffix) for suffix in (".stl", ".obj", ".off", ".glb")},
}
"""Of detections."""


@save.register(Result)
def _save(result: Result, path: str | os.PathLike[str]) -> list[str]:
    require_format(path, FORMATS)
    write_whole(Path(path), FORMATS[Path(path).suffix.lower()](result))
    return []


save.register(OperationResult, save_shape)
save.register(AnalysisResult, save_shape)
