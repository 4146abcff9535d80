"""The thesis's tables 5.1 to 5.5 on regenerated data, beside the numbers it prints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray

from .. import metrics
from .._core import Mirror, Sphere, SurfaceMirror
from ..detection import detect
from ..results import Result
from ..saving.truth import Truth
from ..synthetic import rotate, rotation_matrix
from .experiments import experiment
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
    truth: Mirror
    result: Result
    figures: dict[str, float]
    """The errors by name, the thesis's first."""


def rows() -> Iterator[Row]:
    """Every row; those of Algorithm 4 once more for ``sphere``, which does the same job."""
    for (table, method), experiments in PRINTED.items():
        for name, figures in experiments.items():
            yield Row(table, method, name, figures)
        if method == "sphere_thesis":
            for name, figures in experiments.items():
                yield Row(table, "sphere", name, figures)


def measure(row: Row) -> Outcome:
    """Makes the data, finds the mirror and compares."""
    made = experiment(row.table, row.method, row.name)
    sample = made.make()
    points = sample.points if made.damage is None else made.damage(sample.points)
    truth = Truth(sample.truth, sample.pairs)
    if any(made.rotation):
        points = rotate(points, *made.rotation)
        truth = truth.moved(rotation_matrix(*made.rotation))
    result = detect(points, row.method)
    if isinstance(result.mirror, Sphere):
        sphere = cast(Sphere, truth.mirror)  # spheres are looked for where they are the truth
        figures = metrics.sphere_errors(result.mirror, sphere, points)._asdict()
    else:
        surface = cast(SurfaceMirror, truth.mirror)
        figures = metrics.surface_errors(result.surface_points, surface)._asdict()
        figures["coverage"] = metrics.coverage(result.surface_points, surface, points)
    return Outcome(row, points, truth.mirror, result, figures)
