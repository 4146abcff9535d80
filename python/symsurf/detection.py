"""Finding a mirror, and matching points over a known one."""

from __future__ import annotations

from collections.abc import Callable

from numpy.typing import ArrayLike

from . import _core
from .result import Result

Progress = Callable[[float], "bool | None"]


def detect(
    points: ArrayLike,
    method: str = "auto",
    *,
    normals: ArrayLike | None = None,
    seed: int = 0,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Result:
    """Finds the mirror of a point set.

    Args:
        points: (n, 3) coordinates in any unit: an array, a nested list, a data set with ``points``
            or a mesh with ``vertices``. A C-ordered float64 array is read in place.
        method: one of ``methods()``.
        normals: (n, 3) directions, one a point; taken as lines, so their sign does not count.
        seed: of the methods that draw at random; [0, 2^64).
        threads: 0 means as many as the machine has. The result does not depend on it.
        progress: called with the fraction done, on this thread; returning False cancels.
        **parameters: the method's own, by name: ``methods()[method].parameters``.

    Raises:
        InvalidInput: too few points, not (n, 3), NaN or infinity, all on one point or line, an
            extent beyond what is allowed; normals that are not one a point, not finite or zero.
        InvalidParameter: an unknown method or parameter, or a value out of its range.
        Cancelled: the progress callback returned False.

    A point set without symmetry is no error: its result has a low score.
    """
    return Result.from_fields(
        _core.detect(points, method, normals, seed, threads, progress, parameters)
    )


def match(
    points: ArrayLike,
    mirror: _core.Mirror,
    pair_distance: float = 0.05,
    *,
    threads: int = 0,
    progress: Progress | None = None,
) -> Result:
    """Pairs every point with the input point nearest to its image over a known mirror.

    How a mirror found elsewhere, or one of ``Result.candidates``, fits a point set. Points far off
    the rest have no partners, as in ``detect``, and do not count for the diagonal.

    Args:
        points: (n, 3), as for ``detect``.
        mirror: the known mirror.
        pair_distance: how far from the image a partner may be, as a fraction of the diagonal.
        threads, progress: as for ``detect``.

    Returns:
        A result without a score (0), with the pairs in the order of the points.

    Raises:
        InvalidInput, InvalidParameter, Cancelled: as ``detect`` does.
    """
    if not isinstance(mirror, _core.Mirror):
        raise _core.InvalidInput(f"mirror is of type {type(mirror).__name__}; allowed is a Mirror")
    fields = _core.match(points, mirror, pair_distance, threads, progress)
    return Result.from_fields(fields | {"mirror": mirror})
