"""Points of masks and images, in the world's coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, InvalidParameter
from ..base.options import Reading
from ..shapes import Shape, chosen_by


def world_points(
    values: NDArray[Any],
    affine: NDArray[np.float64],
    reading: Reading,
    space: str | None = None,
) -> Shape:
    """The centres of the voxels whose values are chosen.

    Args:
        values: (i, j, k).
        affine: (4, 4), from the indices of a voxel to the world.
        reading: without scalars, as there is one value per voxel.
        space: of the world.
    """
    if reading.scalars is not None:
        raise InvalidParameter(
            f"scalars is {reading.scalars!r}; allowed is None: the image has one value per voxel"
        )
    if values.ndim != 3 or values.dtype.kind not in "biuf":
        raise InvalidInput(
            f"the image has {values.ndim} axes and values of type {values.dtype}; allowed are 3 axes "
            "and real numbers"
        )
    if (
        reading.threshold is None
        and reading.label is None
        and values.dtype.kind == "f"
        and values.size
    ):
        low, high = values.min(), values.max()
        if low != high and ((values == low) | (values == high)).all():
            values = values == high  # a mask that was saved as an image
    rows = np.argwhere(chosen_by(values, reading, "image"))
    points = np.ascontiguousarray(rows @ affine[:3, :3].T + affine[:3, 3])
    return Shape(points, space=space)
