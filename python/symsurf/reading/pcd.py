"""The clouds of the Point Cloud Library, by pypcd4."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pypcd4 import PointCloud

from .._core import InvalidInput
from ..shape import Shape

_NORMALS = ("normal_x", "normal_y", "normal_z")


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    """x, y and z, and the normals where the file has them; organised clouds row by row, with their
    missing points as NaN."""
    cloud = PointCloud.from_path(path)
    missing = [name for name in "xyz" if name not in cloud.fields]
    if missing:
        raise InvalidInput(f"it has no field {missing[0]}; there are {', '.join(cloud.fields)}")
    has_normals = set(_NORMALS) <= set(cloud.fields)
    return Shape(
        cloud.numpy(("x", "y", "z")).astype(np.float64),
        normals=cloud.numpy(_NORMALS).astype(np.float64) if has_normals else None,
    )
