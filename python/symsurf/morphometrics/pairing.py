"""Which landmark mirrors which: by their names, and by where they are."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput, InvalidParameter, Mirror
from ..base.lengths import diagonal_of
from ..results import Result, mirror_of
from ..shapes import Landmarks
from .assignment import assignment
from .checks import listed, points_of

_LETTERS = {"l": "left", "r": "right"}
_WORDS = {
    "left": "left",
    "right": "right",
    **dict.fromkeys(("sinistra", "sinistral", "sinister"), "left"),
    **dict.fromkeys(("dextra", "dextral", "dexter"), "right"),
}
_PART = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
Side = tuple[tuple[str, ...], str]
"""A name without its side, and the side."""


@dataclass(frozen=True, eq=False)
class LandmarkPairs:
    """Pairs of landmarks that mirror each other."""

    pairs: NDArray[np.int64]
    """(p, 2) indices: where the names tell, left and right; else the lower one first."""
    midline: NDArray[np.int64]
    """(m,) those that mirror themselves."""
    odd: NDArray[np.int64]
    """(o,) those without a counterpart."""
    odd_names: tuple[str, ...] = ()
    """Of these, where there are names."""

    def __repr__(self) -> str:
        odd = f", odd: {listed(self.odd_names or self.odd)}" if len(self.odd) else ""
        return f"LandmarkPairs({len(self.pairs)} pairs, {len(self.midline)} on the midline{odd})"


def landmark_pairs(
    points: ArrayLike | Landmarks,
    mirror: Result | Mirror | str | None = None,
    names: Sequence[str] | None = None,
    *,
    max_distance: float = 0.1,
) -> LandmarkPairs:
    """Pairs landmarks over a mirror.

    Names that differ in nothing but left and right are pairs: ``l_eye`` and ``r_eye``, ``eye.L`` and
    ``eye.R``, ``eyeLeft`` and ``eyeRight``, ``sinistra`` and ``dextra``, in capitals or not. A name
    with a side whose other side is missing is odd; one letter counts as a side where any such pair
    exists. The others are paired with each other, or with themselves, so that the images over the
    mirror lie as close to their partners as they can in all: the assignment of least sum.

    Args:
        points: (k, 3), or what ``read_landmarks`` gives, with its names; without a mirror also (k, 2).
        mirror: a result or a mirror of any kind; None where names tell the pairs: all others then
            mirror themselves.
        names: one a landmark; None: those of ``points``, where it has some.
        max_distance: from an image to its partner, at most; a share of the diagonal above 0.

    Raises:
        InvalidInput: two landmarks with one name, or names that say the same side of the same; points
            that are not finite; neither a mirror nor names that tell pairs.
        InvalidParameter: a ``max_distance`` that is not above 0.
    """
    if not max_distance > 0:
        raise InvalidParameter(f"max_distance is {max_distance!r}; allowed is a number above 0")
    if names is None and isinstance(points, Landmarks):
        names = points.names
    array = points_of(points, may_be_flat=mirror is None)
    if names and len(names) != len(array):
        raise InvalidInput(f"there are {len(names)} names; allowed are {len(array)}, as of points")
    named, odd = _pairs_of_names(names or ())
    rest = np.setdiff1d(np.arange(len(array)), [*sum(named, ()), *odd])
    if mirror is None:
        if not named:
            raise InvalidInput("no names tell left from right; a mirror is needed")
        found = _indices(named, 2), rest, _indices(odd)
    else:
        limit = max_distance * diagonal_of(array)
        pairs, midline, far = _pairs_of_positions(array[rest], mirror_of(mirror), limit)
        both = np.concatenate([_indices(named, 2), rest[pairs]])
        found = both, rest[midline], np.sort(np.concatenate([_indices(odd), rest[far]]))
    return LandmarkPairs(*found, tuple(names[i] for i in found[2]) if names else ())


def _pairs_of_names(names: Sequence[str]) -> tuple[list[tuple[int, int]], list[int]]:
    """The pairs that they tell, left and right, and those whose other side is missing."""
    first: dict[str, int] = {}
    sides: dict[Side, int] = {}
    for index, name in enumerate(names):
        if first.setdefault(name, index) != index:
            raise InvalidInput(f"landmarks {first[name]} and {index} are both called {name!r}")
        side = side_of(name)
        if side is not None and sides.setdefault(side, index) != index:
            other = names[sides[side]]
            raise InvalidInput(f"{other!r} and {name!r} both say {side[1]} of the same landmark")
    lefts = [stem for stem, side in sides if side == "left" and (stem, "right") in sides]
    pairs = [(sides[stem, "left"], sides[stem, "right"]) for stem in lefts]
    odd = [
        index
        for (stem, _), index in sides.items()
        if stem not in lefts and (pairs or _has_word(names[index]))
    ]
    return pairs, odd


def side_of(name: str) -> Side | None:
    """The name without its side, in small letters, and the side; None where it says none, or two."""
    parts = [part.lower() for part in _PART.findall(name)]
    said = [index for index, part in enumerate(parts) if part in _WORDS or part in _LETTERS]
    if len(said) != 1:
        return None
    word = parts.pop(said[0])
    return tuple(parts), (_WORDS | _LETTERS)[word]


def _has_word(name: str) -> bool:
    return any(part.lower() in _WORDS for part in _PART.findall(name))


def _pairs_of_positions(
    points: NDArray[np.float64], mirror: Mirror, limit: float
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Pairs, those that mirror themselves, and those left."""
    if not np.isfinite(points).all():
        missing = np.flatnonzero(~np.isfinite(points).all(axis=1))
        raise InvalidInput(f"landmark {listed(missing)} is missing; allowed are finite points")
    if not len(points):
        return _indices([], 2), _indices([]), _indices([])
    images = mirror.reflect(points)
    gaps = np.linalg.norm(images[:, None] - points[None], axis=2)
    # Capped, all partners that are too far are alike: leaving a landmark alone costs the limit.
    costs = np.minimum(np.where(np.isfinite(gaps), gaps, np.inf), limit)
    partner = assignment(costs)
    own = np.arange(len(points))
    mutual = (partner[partner] == own) & (costs[own, partner] < limit)
    lower = np.flatnonzero(mutual & (own < partner))
    pairs = np.column_stack([lower, partner[lower]])
    return pairs, np.flatnonzero(mutual & (own == partner)), np.flatnonzero(~mutual)


def _indices(values: Sequence[object], width: int = 1) -> NDArray[np.int64]:
    array = np.array(values, dtype=np.int64)
    return array if width == 1 else array.reshape(-1, width)
