"""Laser scans, by laspy: LAS and LAZ."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np

from ..shape import Shape


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    """All points, with the file's scale and offset applied."""
    scan = laspy.read(path)
    return Shape(np.array(scan.xyz, dtype=np.float64))
