"""NIfTI masks and images, by nibabel."""

from __future__ import annotations

from pathlib import Path

import nibabel
import numpy as np
from nibabel.imageglobals import ErrorLevel, LoggingOutputSuppressor

from ..shape import Shape
from .voxels import world_points


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    """The centres of the voxels that the threshold chooses, in NIfTI's world coordinates: RAS."""
    # A header that nibabel would repair, and print so, is an error where its voxel sizes are wrong.
    with LoggingOutputSuppressor(), ErrorLevel(35):
        image = nibabel.Nifti1Image.from_filename(path)
    values = np.asanyarray(image.dataobj)
    while values.ndim > 3 and values.shape[-1] == 1:
        values = values[..., 0]
    return world_points(values, image.affine, threshold, scalars)
