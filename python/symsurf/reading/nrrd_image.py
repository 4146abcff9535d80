"""NRRD masks and images, by pynrrd."""

from __future__ import annotations

from pathlib import Path

import nrrd
import numpy as np

from ..shape import Shape
from .voxels import world_points


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    """The centres of the voxels that the threshold chooses, in the space that the header names:
    LPS where 3D Slicer wrote it."""
    values, header = nrrd.read(str(path))
    affine = np.eye(4)
    directions = header.get("space directions")
    spacings = header.get("spacings")
    if directions is not None and np.shape(directions) == (3, 3):
        affine[:3, :3] = np.asarray(directions, dtype=float).T
    elif spacings is not None and np.shape(spacings) == (3,):
        affine[:3, :3] = np.diag(np.where(np.isnan(spacings), 1, spacings))
    origin = header.get("space origin")
    if origin is not None and np.shape(origin) == (3,):
        affine[:3, 3] = origin
    return world_points(values, affine, threshold, scalars)
