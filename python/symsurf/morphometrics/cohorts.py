"""Symmetric and asymmetric shape of the individuals of a cohort."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput, InvalidParameter
from ..results.summary import Summarised
from .anova import ERROR, TERMS, AnovaRow, anova
from .checks import indices_of, listed, numbers, pairs_of, require_once
from .pairing import LandmarkPairs
from .procrustes import centroid_sizes, is_mirrored, reflected, superimposed

_LEVELS = ("individual", "replicate")
_MOST_PERMUTATIONS = 1_000_000


@dataclass(frozen=True, eq=False, repr=False)
class Cohort(Summarised):
    """Effects of individuals and sides on the shape of landmarks, superimposed at unit centroid
    size."""

    table: dict[str, AnovaRow]
    """The rows "individual": variation among individuals; "side": directional asymmetry;
    "individual_side": fluctuating asymmetry; "error": of measurement, between replicates."""
    mean: NDArray[np.float64]
    """(k, d) of all, symmetric."""
    symmetric: NDArray[np.float64]
    """(individuals, k, d) the mean of both sides, over the replicates."""
    asymmetric: NDArray[np.float64]
    """(individuals, k, d) what the landmarks differ from ``symmetric`` by: half the difference of the
    sides."""
    size: NDArray[np.float64]
    """(individuals, replicates) centroid sizes, input units, of matching symmetry the mean of both:
    times it, shape is in them."""
    pairs: NDArray[np.int64]
    """(p, 2) indices of landmarks; none of matching symmetry."""
    midline: NDArray[np.int64]
    """(m,) indices."""

    @property
    def directional(self) -> NDArray[np.float64]:
        """(k, d) the mean of ``asymmetric``."""
        return self.asymmetric.mean(axis=0)

    @property
    def fluctuating(self) -> NDArray[np.float64]:
        """(individuals, k, d) ``asymmetric`` without ``directional``."""
        return self.asymmetric - self.directional

    @property
    def deviation(self) -> NDArray[np.float64]:
        """(k,) the standard deviation of ``asymmetric`` about ``directional``."""
        squares = (self.fluctuating**2).sum(axis=(0, 2))
        return np.sqrt(squares / (len(self.asymmetric) - 1))

    @property
    def magnitude(self) -> NDArray[np.float64]:
        """(individuals, k) lengths of ``asymmetric``."""
        return np.linalg.norm(self.asymmetric, axis=2)

    def percentile(self, individual: int) -> NDArray[np.float64]:
        """Percentile (k,) of the asymmetry of an individual among the others, at each landmark or
        vertex: the share in % with a smaller asymmetry; equal ones count one half.

        Raises InvalidParameter for an individual that there is none of.
        """
        count = len(self.asymmetric)
        if not isinstance(individual, (int, np.integer)) or not 0 <= individual < count:
            raise InvalidParameter(f"individual is {individual!r}; allowed are 0 to {count - 1}")
        magnitude = self.magnitude
        own, others = magnitude[individual], np.delete(magnitude, individual, axis=0)
        return 50 * ((others < own).mean(axis=0) + (others <= own).mean(axis=0))

    @property
    def summary(self) -> dict[str, str]:
        """The table in words, one line per row."""
        n, k, _ = self.symmetric.shape
        words = {"individuals": str(n), "landmarks": str(k), "replicates": str(self.size.shape[1])}
        return words | {name.replace("_", " x "): _text(row) for name, row in self.table.items()}

    def __repr__(self) -> str:
        return f"Cohort({len(self.symmetric)} individuals, {len(self.mean)} landmarks)"


def _text(row: AnovaRow) -> str:
    numbers = {"SS": row["ss"], "MS": row["ms"], "F": row["F"], "p": row["p"]}
    texts = [f"{name} {value:.6g}" for name, value in numbers.items() if not np.isnan(value)]
    return ", ".join([f"df {row['df']}", *texts])


def cohort(
    landmarks: ArrayLike | Sequence[Any],
    pairs: ArrayLike | LandmarkPairs | None = None,
    midline: ArrayLike | None = None,
    *,
    other_side: ArrayLike | Sequence[Any] | None = None,
    permutations: int = 999,
    seed: int = 0,
) -> Cohort:
    """Computes directional and fluctuating asymmetry of individuals by Procrustes ANOVA.

    Object symmetry (Klingenberg, Barluenga and Meyer 2002): every configuration and its copy,
    reflected and with left and right relabelled, are superimposed, and projected into the tangent
    space at their mean. With y of individual i, side j (the configuration or its copy) and replicate
    r it is ``y_ijr = mean + individual_i + side_j + individual_side_ij + error_ijr``. Steps, sums of
    squares, degrees of freedom and F are those of R's geomorph (``bilat.symmetry``).

    Args:
        landmarks: (individuals, replicates, k, 3), or (individuals, k, 3) of one replicate each; flat
            ones (..., 2). An array, or nested lists of arrays, of what ``read_landmarks`` gives or of
            meshes of one topology. In any unit, pose and size.
        pairs: (p, 2) indices of landmarks that mirror each other, each in one pair; or what
            ``landmark_pairs`` gives, with its midline.
        midline: (m,) those that mirror themselves; None: all that are in no pair.
        other_side: matching symmetry, in place of pairs: the same landmarks of the other organ, such
            as the right hands of the same individuals, in the same order; mirrored beforehand or not.
        permutations: for p, besides the data as they are, 0 to 1,000,000; 0 gives no p.
        seed: of the permutations, 0 or more.

    Raises:
        InvalidInput: fewer than two individuals; numbers of landmarks or of replicates that differ; a
            landmark that is missing (not finite), out of range, in two pairs, or neither in a pair
            nor on the midline; an odd landmark in ``pairs``; landmarks that all coincide.
        InvalidParameter: permutations or a seed out of range; pairs and other_side both or neither.
    """
    _require_whole("permutations", permutations, _MOST_PERMUTATIONS)
    _require_whole("seed", seed, None)
    if (pairs is None) == (other_side is None):
        raise InvalidParameter(
            "pairs and other_side are both given, or neither; allowed is one of them"
        )
    given = _configurations(landmarks, "landmarks")
    k = given.shape[2]
    if other_side is not None:
        both, alone = np.empty((0, 2), np.int64), np.arange(k)
        sides, size = _matching(given, _configurations(other_side, "other_side"))
    else:
        both, alone = _relabelling(pairs, midline, k)
        sides, size = _object(given, both), centroid_sizes(given)
    dimensions = _dimensions(len(both), len(alone), given.shape[3], other_side is None)
    variables = sides.reshape(*sides.shape[:3], -1)
    means = sides.mean(axis=2)
    return Cohort(
        table=anova(variables, dimensions, permutations, seed),
        mean=means.mean(axis=(0, 1)),
        symmetric=means.mean(axis=0),
        asymmetric=(means[0] - means[1]) / 2,
        size=size,
        pairs=both,
        midline=alone,
    )


def _object(given: NDArray[np.float64], pairs: NDArray[np.int64]) -> NDArray[np.float64]:
    """(2, individuals, replicates, k, d): the configurations, and their reflected copies."""
    n, r, k, d = given.shape
    first = superimposed(given.reshape(n * r, k, d))
    order = np.arange(k)
    order[pairs] = pairs[:, ::-1]
    copies = reflected(first)[:, order]
    return superimposed(np.concatenate([first, copies])).reshape(2, n, r, k, d)


def _matching(
    one: NDArray[np.float64], other: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(2, individuals, replicates, k, d): both sides, and their mean sizes."""
    if one.shape != other.shape:
        raise InvalidInput(
            f"other_side has shape {other.shape}; allowed is that of landmarks, {one.shape}"
        )
    shape = one.shape
    first, second = (each.reshape(-1, *shape[2:]) for each in (one, other))
    second = reflected(second) if is_mirrored(first, second) else second
    size = (centroid_sizes(one) + centroid_sizes(other)) / 2
    return superimposed(np.concatenate([first, second])).reshape(2, *shape), size


def _relabelling(
    pairs: Any, midline: ArrayLike | None, count: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs and midline, each landmark once."""
    if isinstance(pairs, LandmarkPairs):
        if len(pairs.odd):
            odd = listed(pairs.odd_names or pairs.odd)
            raise InvalidInput(f"landmarks without a counterpart: {odd}; allowed is without them")
        pairs, midline = pairs.pairs, pairs.midline if midline is None else midline
    both = pairs_of(pairs, count)
    if not len(both):
        raise InvalidInput("there are no pairs; allowed is at least one")
    rest = np.setdiff1d(np.arange(count), both)
    if midline is None:
        return both, rest
    alone = indices_of(midline, count, "midline").reshape(-1)
    require_once(np.concatenate([both.ravel(), alone]), "pairs and midline")
    if len(alone) != len(rest):
        left = np.setdiff1d(rest, alone)
        raise InvalidInput(
            f"landmark {listed(left)} is in no pair and not on the midline; allowed is one of them"
        )
    return both, alone


def _dimensions(p: int, m: int, d: int, is_object: bool) -> dict[str, int]:
    """Of shape space, of its symmetric and its asymmetric part, a row of the table; of p pairs and m
    landmarks on the midline. A size, d moves and d (d - 1) / 2 rotations are taken off the
    coordinates: the size, d - 1 moves and the rotations within the plane off the symmetric ones."""
    symmetric = d * p + (d - 1) * m - 1 - (d - 1) - (d - 1) * (d - 2) // 2
    asymmetric = d * p + m - 1 - (d - 1)
    every = d * (2 * p + m) - 1 - d - d * (d - 1) // 2
    if not is_object:
        return dict.fromkeys((*TERMS, ERROR), every)
    return dict(zip(TERMS, (symmetric, asymmetric, asymmetric))) | {ERROR: every}


def _configurations(given: Any, what: str) -> NDArray[np.float64]:
    """(individuals, replicates, k, d), all sound. Raises InvalidInput."""
    array = _stacked(given, what)
    if array.ndim == 3:
        array = array[:, None]
    if array.ndim != 4 or array.shape[3] not in (2, 3):
        raise InvalidInput(
            f"{what} have shape {array.shape}; allowed are (individuals, replicates, k, 3) and "
            "(individuals, k, 3)"
        )
    n, r, k, _ = array.shape
    if n < 2 or r < 1 or k < 3:
        raise InvalidInput(
            f"{what} are of {n} individuals with {r} replicates and {k} landmarks; allowed are at "
            "least 2, 1 and 3"
        )
    missing = np.argwhere(~np.isfinite(array).all(axis=3))
    if len(missing):
        i, replicate, landmark = missing[0]
        raise InvalidInput(
            f"landmark {landmark} of individual {i}, replicate {replicate}, is missing (not finite), "
            f"and {len(missing) - 1} more; allowed are finite ones: leave out the landmark or the "
            "individual"
        )
    flat = np.argwhere(np.ptp(array, axis=2).max(axis=2) == 0)
    if len(flat):
        raise InvalidInput(f"the landmarks of individual {flat[0][0]} all coincide")
    return array


def _stacked(given: Any, what: str, levels: Sequence[str] = _LEVELS) -> NDArray[np.float64]:
    """An array of nested lists of arrays, or of what has points."""
    if hasattr(given, "points"):
        return numbers(given.points, what)
    if not isinstance(given, (list, tuple)) or not levels or not _is_nested(given):
        return numbers(given, what)
    level, below = levels[0], levels[1:]
    parts = [_stacked(each, f"{what} of {level} {i}", below) for i, each in enumerate(given)]
    for name in ("names", "faces"):
        _require_same(given, name, f"{what} of {level}")
    for i, part in enumerate(parts):
        if part.shape != parts[0].shape:
            raise InvalidInput(
                f"{what} have shape {part.shape} of {level} {i} and {parts[0].shape} of {level} 0; "
                "allowed is one shape"
            )
    return np.array(parts)


def _is_nested(given: Sequence[Any]) -> bool:
    """Whether it is a list of configurations, not of landmarks or numbers."""
    first = given[0] if given else None
    if isinstance(first, (list, tuple, np.ndarray)) and len(first):
        return not np.isscalar(first[0])
    return hasattr(first, "points")


def _require_same(given: Sequence[Any], attribute: str, what: str) -> None:
    """Raises InvalidInput where what some of the given have, as faces, differs from the first's."""
    first = getattr(given[0], attribute, None)
    for i, each in enumerate(given):
        if not np.array_equal(getattr(each, attribute, None), first):  # type: ignore[arg-type]
            raise InvalidInput(
                f"{what} {i} have other {attribute} than those of 0; allowed are the same"
            )


def _require_whole(name: str, value: Any, most: int | None) -> None:
    is_whole = isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if not is_whole or value < 0 or (most is not None and value > most):
        allowed = "0 or more" if most is None else f"0 to {most}"
        raise InvalidParameter(f"{name} is {value!r}; allowed are whole numbers, {allowed}")
