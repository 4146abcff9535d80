"""The formats that the core reads."""

from __future__ import annotations

from pathlib import Path

from .. import _core
from ..shapes import Choice, Shape
from ..shapes.space import space_in

_HEAD = 4096  # bytes that comments with the axes stand in


def read(path: Path, choice: Choice) -> Shape:
    with path.open("rb") as file:
        space = space_in(file.read(_HEAD))
    return Shape(**_core.read(path), space=space)
