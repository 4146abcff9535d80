"""Laser scans that are packed, by laspy: LAZ."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np

from ..base.options import Reading
from ..shapes import Shape
from . import las


def read(path: Path, reading: Reading) -> Shape:
    """All points, with the file's scale and offset applied."""
    *_, is_packed = las.layout(path)
    if not is_packed:
        return las.read(path, reading)
    scan = laspy.read(path)
    return Shape(np.array(scan.xyz, dtype=np.float64))
