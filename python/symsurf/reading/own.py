"""The formats that the core reads."""

from __future__ import annotations

from pathlib import Path

from .. import _core
from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape
from ..shapes.space import space_in
from .splat import ply_opacity

_HEAD = 4096  # bytes that comments with the axes stand in


def read(path: Path, reading: Reading) -> Shape:
    with path.open("rb") as file:
        space = space_in(file.read(_HEAD))
    try:
        weights = ply_opacity(path) if path.suffix.lower() == ".ply" else None
        return Shape(**_core.read(path), space=space, weights=weights)
    except InvalidInput as error:  # which has the name
        raise InvalidInput(str(error).removeprefix(f"{path}: ")) from error
