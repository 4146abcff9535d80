"""Points carried along while a curved mirror is laid flat, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Mirror, Plane
from ..results import Result, mirror_of


def bend(
    points: ArrayLike, mirror: Result | Mirror | str, back: bool = False
) -> NDArray[np.float64]:
    """Points (n, 3) carried along while a curved mirror flattens into its plane, or, with ``back``,
    while the plane bends into the mirror.

    Each point keeps its distance from the mirror and the coordinates of its foot. A cylinder
    unrolls; other mirrors are laid out from the middle of their footprint, true to length along the
    two lines through it. A shape that the mirror reflects onto itself comes out symmetric about
    ``straight_mirror(mirror)``. A mirror made by hand is laid out over the points' own feet.

    Args:
        points: (n, 3), in the unit and pose of the mirror.
        mirror: of any kind, or a result that has one.
        back: False: from the mirror to its plane; True: from the plane to the mirror.

    Returns:
        (n, 3), in input units; rows without a foot go rigidly with the nearest that has one.

    Raises:
        InvalidInput: no point has a foot; a result without a mirror; points as ``detect`` refuses
            them.
        InvalidParameter: neither a mirror nor a result.
    """
    return _core.bend(points, mirror_of(mirror), back)


def straight_mirror(mirror: Result | Mirror | str, points: ArrayLike | None = None) -> Plane:
    """The plane that ``bend`` flattens a mirror into.

    Args:
        mirror: of any kind, or a result that has one.
        points: (n, 3), for a mirror made by hand.

    Raises:
        InvalidInput: no point has a foot; a result without a mirror.
        InvalidParameter: neither a mirror nor a result.
    """
    return _core.straight_mirror(mirror_of(mirror), points)
