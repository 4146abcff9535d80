"""Procrustes ANOVA of individuals and sides, with p-values by permutation."""

from __future__ import annotations

from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

TERMS = ("individual", "side", "individual_side")
ERROR = "error"
_ROUNDING = 1e-28  # of a sum of squares, an observation: the square of 1e-14 at unit centroid size
_TIE = 1e-9  # of F: the same permutation of the data, summed in another order
Sides = NDArray[np.float64]
"""(2, n, r, q): q shape variables of each side of n individuals with r replicates."""


class AnovaRow(TypedDict):
    """A row of the table of a cohort; NaN where there is no such number."""

    ss: float
    """Sum of squares, over all observations and coordinates, at unit centroid size."""
    df: int
    """Degrees of freedom of the observations, as R's geomorph counts them."""
    ms: float
    """``ss / df``."""
    F: float
    """``ms`` over that of ``individual_side``, whose own is over that of ``error``; without
    replicates it has none."""
    p: float
    """Share of the permutations, the data as they are among them, with an F as large."""
    df_shape: int
    """``df`` times the dimensions of shape space that the row is of (Klingenberg, Barluenga and Meyer
    2002): what Goodall's F, the ratio of ``ss / df_shape``, is looked up with."""


def anova(
    sides: Sides, dimensions: dict[str, int], permutations: int, seed: int
) -> dict[str, AnovaRow]:
    """The table of shape variables by individual, side and their interaction, in this order.

    p by residual randomisation: residuals of the model without the term are permuted over all
    observations (Collyer and Adams 2018).

    Args:
        dimensions: of shape space, a row.
        permutations: besides the data as they are; 0 gives no p.
    """
    _, n, r, _ = sides.shape
    df = {"individual": n - 1, "side": 1, "individual_side": n - 1, ERROR: 2 * n * (r - 1)}
    compact = _compact(sides)
    least = _ROUNDING * 2 * n * r
    sums = {name: ss if ss > least else 0.0 for name, ss in _sums_of_squares(compact).items()}
    f = _ratios(sums, df)
    p = _p_values(compact, f, df, permutations, np.random.default_rng(seed))
    return {
        name: AnovaRow(
            ss=sums[name],
            df=df[name],
            ms=_ratio(sums[name], df[name]),
            F=f.get(name, float("nan")),
            p=p.get(name, float("nan")),
            df_shape=df[name] * dimensions[name],
        )
        for name in (*TERMS, ERROR)
    }


def _compact(sides: Sides) -> Sides:
    """As many variables as observations at most, with the same distances: of meshes far fewer."""
    rows = sides.reshape(-1, sides.shape[-1])
    rows = rows - rows.mean(axis=0)
    if rows.shape[1] > len(rows):
        rows = np.linalg.qr(rows.T)[1].T
    return rows.reshape(*sides.shape[:3], -1)


def _parts(sides: Sides) -> dict[str, Sides]:
    """What each term explains, as arrays that broadcast; they are orthogonal."""
    mean = sides.mean(axis=(0, 1, 2), keepdims=True)
    of_individuals = sides.mean(axis=(0, 2), keepdims=True)
    of_sides = sides.mean(axis=(1, 2), keepdims=True)
    of_both = sides.mean(axis=2, keepdims=True)
    return {
        "individual": of_individuals - mean,
        "side": of_sides - mean,
        "individual_side": of_both - of_individuals - of_sides + mean,
        ERROR: sides - of_both,
    }


def _sums_of_squares(sides: Sides) -> dict[str, float]:
    count = sides.shape[0] * sides.shape[1] * sides.shape[2]
    return {
        name: float((part**2).sum()) * count / (part.size // part.shape[-1])
        for name, part in _parts(sides).items()
    }


def _ratios(sums: dict[str, float], df: dict[str, int]) -> dict[str, float]:
    """F of the terms that have one."""
    ms = {name: _ratio(sums[name], df[name]) for name in sums}
    f = {name: _ratio(ms[name], ms["individual_side"]) for name in TERMS[:2]}
    return f | ({"individual_side": _ratio(ms["individual_side"], ms[ERROR])} if df[ERROR] else {})


def _ratio(above: float, below: float) -> float:
    return above / below if below > 0 else float("nan")


def _p_values(
    sides: Sides,
    f: dict[str, float],
    df: dict[str, int],
    permutations: int,
    generator: np.random.Generator,
) -> dict[str, float]:
    if not permutations:
        return {}
    parts = _parts(sides)
    residuals, left = {}, sides
    for name in TERMS:  # of the model with the terms before it
        residuals[name] = left
        left = left - parts[name]
    f = {name: ratio for name, ratio in f.items() if not np.isnan(ratio)}
    as_large = dict.fromkeys(f, 1)
    for _ in range(permutations):
        order = generator.permutation(sides[..., 0].size)
        for name, observed in f.items():
            rows = residuals[name].reshape(len(order), -1)[order].reshape(sides.shape)
            as_large[name] += _ratios(_sums_of_squares(rows), df)[name] >= observed * (1 - _TIE)
    return {name: many / (permutations + 1) for name, many in as_large.items()}
