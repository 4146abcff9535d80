"""Points of masks and images, in the world's coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, InvalidParameter
from ..shape import Shape
from ..thresholds import above


def world_points(
    values: NDArray[Any],
    affine: NDArray[np.float64],
    threshold: float | None,
    scalars: str | None,
) -> Shape:
    """The centres of the voxels whose values the threshold chooses.

    Args:
        values: (i, j, k).
        affine: (4, 4), from the indices of a voxel to the world.
        threshold: see ``symsurf.detect``.
        scalars: None, as there is one value a voxel.
    """
    if scalars is not None:
        raise InvalidParameter(
            f"scalars is {scalars!r}; allowed is None: the image has one value a voxel"
        )
    if values.ndim != 3 or values.dtype.kind not in "biuf":
        raise InvalidInput(
            f"the image has {values.ndim} axes and values of type {values.dtype}; allowed are 3 axes "
            "and real numbers"
        )
    if threshold is None and values.dtype.kind == "f" and values.size:
        low, high = values.min(), values.max()
        if low != high and ((values == low) | (values == high)).all():
            values = values == high  # a mask that was saved as an image
    rows = np.argwhere(above(values, threshold, "image"))
    return Shape(np.ascontiguousarray(rows @ affine[:3, :3].T + affine[:3, 3]))
