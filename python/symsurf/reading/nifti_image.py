"""NIfTI masks and images, by nibabel."""

from __future__ import annotations

from math import prod
from pathlib import Path

import nibabel
import numpy as np
from nibabel.imageglobals import ErrorLevel, LoggingOutputSuppressor

from .._core import InvalidInput
from ..shape import Shape
from ..thresholds import Choice
from .voxels import world_points


def read(path: Path, choice: Choice) -> Shape:
    """The centres of the voxels that are chosen, in NIfTI's world coordinates: RAS."""
    # A header that nibabel would repair, and print so, is an error where its voxel sizes are wrong.
    with LoggingOutputSuppressor(), ErrorLevel(35):
        image = nibabel.load(path)
    needed = image.dataobj.offset + prod(image.shape) * image.get_data_dtype().itemsize
    if needed > (size := path.stat().st_size):
        raise InvalidInput(f"the file is truncated: its values end at byte {needed}, it has {size}")
    values = np.asanyarray(image.dataobj)
    while values.ndim > 3 and values.shape[-1] == 1:
        values = values[..., 0]
    has_world = int(image.header["sform_code"]) > 0 or int(image.header["qform_code"]) > 0
    return world_points(values, image.affine, choice, "RAS" if has_world else None)
