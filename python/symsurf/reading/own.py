"""The formats that the core reads."""

from __future__ import annotations

from pathlib import Path

from .. import _core
from ..shape import Shape
from ..space import space_in
from ..thresholds import Choice

_HEAD = 4096  # bytes that comments with the axes stand in


def read(path: Path, choice: Choice) -> Shape:
    with path.open("rb") as file:
        space = space_in(file.read(_HEAD))
    return Shape(**_core.read(path), space=space)
