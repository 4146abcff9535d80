"""Several measurements of one part."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..detection import detect
from ..detection.repeating import Measurement, closest, deviations
from .operate import operate


def repeatability(
    shapes: Iterable[object], *, asymmetry: bool = True, **search: Any
) -> dict[str, Any]:
    """Standard deviations over several measurements of one part, in one pose.

    Args:
        shapes: at least two point sets, meshes or files, as for ``detect``.
        asymmetry: False: without "rms_sd", which takes longest.
        **search: the method and its options, as for ``detect``.

    Returns:
        "repeats", the number of measurements in which a mirror is found, and if these are two or
        more "angle_sd" of the mirror's normal from its mean, degrees, "offset_sd" of its distance from
        the centroid of the first measurement and "rms_sd" of the asymmetry, both in input units, and
        "score_sd". Over a curved mirror normal and distance are those at the foot of that centroid.

    Raises InvalidInput, InvalidParameter and Cancelled as ``detect`` does.
    """
    measured: list[Measurement] = []
    first = np.empty((0, 3))
    for shape in shapes:
        found = detect(shape, **search)
        points = np.asarray(found.points, dtype=float)
        first = first if measured else points
        each = closest(
            [Measurement(every.mirror, every.score) for every in (found, *found.candidates)],
            measured[0].mirror if measured else None,
            points,
        )
        if asymmetry and each.mirror is not None:
            each = each._replace(rms=operate("asymmetry", shape, each.mirror).statistics["rms"])
        measured.append(each)
    return deviations(measured, first)
