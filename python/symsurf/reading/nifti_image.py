"""NIfTI masks and images, by nibabel."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from math import prod
from pathlib import Path
from typing import Any

import nibabel
import numpy as np
from nibabel.imageglobals import ErrorLevel, logger

from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape
from .voxels import world_points

_SECOND = (540, int.from_bytes((540).to_bytes(4, "little"), "big"))


def read(path: Path, reading: Reading) -> Shape:
    """The centres of the voxels that are chosen, in NIfTI's world coordinates: RAS."""
    # A header that nibabel would repair, and print so, is an error where its voxel sizes are wrong.
    with _quiet(), ErrorLevel(35):
        image = _image_type(path).from_filename(path)
    sides = [int(side) for side in image.shape]
    needed = int(image.dataobj.offset) + prod(sides) * image.get_data_dtype().itemsize
    if min(sides, default=0) < 1:
        raise InvalidInput(f"the image has {sides} voxels; allowed are 1 or more along each axis")
    if needed > (size := path.stat().st_size):
        raise InvalidInput(f"the file is truncated: its values end at byte {needed}, it has {size}")
    values = np.asanyarray(image.dataobj)
    while values.ndim > 3 and values.shape[-1] == 1:
        values = values[..., 0]
    has_world = int(image.header["sform_code"]) > 0 or int(image.header["qform_code"]) > 0
    return world_points(values, image.affine, reading, "RAS" if has_world else None)


@contextmanager
def _quiet() -> Iterator[None]:
    """Without what nibabel would print."""
    before, logger.disabled = logger.disabled, True
    try:
        yield
    finally:
        logger.disabled = before


def _image_type(path: Path) -> Any:
    """By the length of the header, which the second version begins with in either order of bytes."""
    with path.open("rb") as file:
        is_second = struct.unpack("<i", file.read(4).ljust(4))[0] in _SECOND
    return nibabel.Nifti2Image if is_second else nibabel.Nifti1Image
