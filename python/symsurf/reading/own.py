"""The formats that the core reads."""

from __future__ import annotations

from pathlib import Path

from .. import _core
from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape
from ..shapes.space import space_in

_HEAD = 4096  # bytes that comments with the axes stand in


def read(path: Path, reading: Reading) -> Shape:
    with path.open("rb") as file:
        space = space_in(file.read(_HEAD))
    try:
        return Shape(**_core.read(path), space=space)
    except InvalidInput as error:  # which has the name
        raise InvalidInput(str(error).removeprefix(f"{path}: ")) from error
