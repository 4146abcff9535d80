"""Landmarks on the other side of a shape."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput, Mirror
from ..mirror_operations.operate import operate
from ..results import Correspondences, Result
from ..shapes import Landmarks
from .checks import points_of


def carry_landmarks(
    points: ArrayLike | Landmarks,
    shape: object,
    result: Result | Mirror | str | None = None,
    *,
    pairing: str = "homologous",
    **options: Any,
) -> NDArray[np.float64]:
    """Transfers landmarks (k, 3) to the other side of the shape on which they lie.

    A landmark goes with the vertex v next to it, to where ``correspondences`` finds v on the other
    side, v': to ``v' + reflect(x) - reflect(v)``, the way from the vertex being mirrored.

    Args:
        points: (k, 3), in the unit and the axes of the shape.
        shape: see ``correspondences``.
        result: the mirror; without it found first.
        pairing: "homologous", or "closest": see ``correspondences``.
        options: the others of ``correspondences``, such as ``max_distance`` and ``threads``.

    Returns NaN for a landmark that is missing or whose vertex has no counterpart. Errors are those of
    ``correspondences``.
    """
    array = points_of(points)
    found = cast(
        Correspondences, operate("correspondences", shape, result, pairing=pairing, **options)
    )
    vertices = np.asarray(found.given.points, dtype=np.float64)
    if not np.isfinite(vertices).all():
        raise InvalidInput("the shape has points that are not finite; allowed are finite ones")
    carried = np.full(array.shape, np.nan)
    there = np.flatnonzero(np.isfinite(array).all(axis=1))
    gaps = (np.linalg.norm(vertices - array[i], axis=1).argmin() for i in there)
    nearest = np.fromiter(gaps, np.int64, len(there))
    way = found.mirror.reflect(array[there]) - found.mirror.reflect(vertices[nearest])
    carried[there] = _counterparts(found, vertices, nearest) + way
    return carried


def _counterparts(
    found: Correspondences, vertices: NDArray[np.float64], chosen: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Where the chosen vertices come out: on a face of a mesh, at a point of a cloud; else NaN."""
    index = found.index[chosen]
    positions = np.where((index >= 0)[:, None], vertices[index], np.nan)
    if found.face is None or found.weights is None or found.given.faces is None:
        return positions
    face = found.face[chosen]
    corners = vertices[found.given.faces[face]]
    on_face = np.einsum("kc,kcx->kx", found.weights[chosen], corners)
    return np.where((face >= 0)[:, None], on_face, positions)
