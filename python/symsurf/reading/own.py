"""The formats that the core reads."""

from __future__ import annotations

from pathlib import Path

from .. import _core
from ..shape import Shape


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    return Shape(**_core.read(path))
