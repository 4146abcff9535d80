"""The thesis's tables 5.1 to 5.5 on regenerated data, beside the numbers it prints, and figures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import metrics
from .._core import Mirror, Sphere, SurfaceMirror
from ..detection import detect
from ..results import Result
from ..saving.truth import Truth
from ..synthetic import Sample, rotate, rotation_matrix
from .experiments import FIGURES, experiment
from .printed import PRINTED, Figures


@dataclass(frozen=True)
class Row:
    table: str
    method: str
    name: str
    printed: Figures
    """What the thesis prints, in the order of ``Outcome.figures``; empty where it prints nothing."""


@dataclass(frozen=True, eq=False)
class Outcome:
    row: Row
    points: NDArray[np.float64]
    truth: Mirror | None
    """None of an object whose mirror is not known."""
    result: Result
    figures: dict[str, float]
    """The errors by name, the thesis's first; none of what it shows without numbers."""


def rows() -> Iterator[Row]:
    """Every row; those of Algorithm 4 once more for ``sphere``, which does the same job."""
    for (table, method), experiments in PRINTED.items():
        for name, figures in experiments.items():
            yield Row(table, method, name, figures)
        if method == "sphere_thesis":
            for name, figures in experiments.items():
                yield Row(table, "sphere", name, figures)
    for (figure, method), names in FIGURES.items():
        for name in names:
            yield Row(figure, method, name, ())


def measure(row: Row) -> Outcome:
    """Makes the data, finds the mirror and compares."""
    made = experiment(row.table, row.method, row.name)
    sample = made.make()
    points, mirror = (sample.points, sample.truth) if isinstance(sample, Sample) else (sample, None)
    if made.damage is not None:
        points = made.damage(points)
    if mirror is not None and any(made.rotation):
        points = rotate(points, *made.rotation)
        mirror = (
            Truth(mirror, np.empty((0, 2), np.int64)).moved(rotation_matrix(*made.rotation)).mirror
        )
    result = detect(points, row.method)
    return Outcome(row, points, mirror, result, _figures(points, mirror, result))


def _figures(points: NDArray[np.float64], truth: Mirror | None, found: Result) -> dict[str, float]:
    if isinstance(truth, Sphere) and isinstance(found.mirror, Sphere):
        return metrics.sphere_errors(found.mirror, truth, points)._asdict()
    if not isinstance(truth, SurfaceMirror):
        return {}
    errors = metrics.surface_errors(found.surface_points, truth)._asdict()
    return errors | {"coverage": metrics.coverage(found.surface_points, truth, points)}
