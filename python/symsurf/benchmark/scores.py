"""The measures of the benchmark."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from .answers import Answer
from .cases import BenchmarkSample

NEAR = 0.01
"""Of the diagonal: an image as near to the true one is right."""
_SIMPLE = {"plane", "cylinder", "sphere"}


class Figures(NamedTuple):
    """How good an answer to a case is; errors are over the diagonal, of images that are not there
    infinite."""

    median: float
    """Of the errors of the images; NaN without a true mirror."""
    ninetieth: float
    within: float
    """Which share of the images is right."""
    kind: float
    """1: the kind of the mirror is right, or that there is none; NaN where no kind was given."""
    found: float
    """1: a mirror was said to be found."""


def figures_of(sample: BenchmarkSample, answer: Answer | None) -> Figures:
    """No answer counts as one without a mirror, and is never right."""
    found = float(answer is not None and answer.found)
    if sample.images is None:
        right = 0.0 if answer is None else 1 - found
        return Figures(np.nan, np.nan, np.nan, right, found)
    if answer is None or answer.images is None:
        return Figures(np.inf, np.inf, 0.0, 0.0, found)
    errors = np.linalg.norm(answer.images - sample.images, axis=1) / sample.diagonal
    errors = np.where(np.isnan(errors), np.inf, errors)
    middle, ninetieth = np.quantile(errors, (0.5, 0.9), method="nearest")
    within = float((errors <= NEAR).mean())
    return Figures(float(middle), float(ninetieth), within, _kind(sample.kind, answer.kind), found)


def _kind(true: str, said: str) -> float:
    if not said:
        return np.nan
    return float(said == true if true in _SIMPLE else said not in _SIMPLE | {"none"})


class Summary(NamedTuple):
    """Of several cases: medians of the errors, shares of the rest."""

    cases: int
    median: float
    ninetieth: float
    within: float
    """Which share of the cases has its median error within 1 % of the diagonal."""
    kind: float
    found: float


def summary(figures: Iterable[Figures]) -> Summary:
    """Over cases with a mirror, or over such without one."""
    rows = np.array(list(figures), dtype=float)
    median, ninetieth = (np.quantile(rows[:, k], 0.5, method="nearest") for k in (0, 1))
    near = np.where(np.isnan(rows[:, 0]), np.nan, rows[:, 0] <= NEAR)
    kinds = rows[:, 3][~np.isnan(rows[:, 3])]
    return Summary(
        len(rows),
        float(median),
        float(ninetieth),
        float(near.mean()),
        float(kinds.mean()) if len(kinds) else np.nan,
        float(rows[:, 4].mean()),
    )
