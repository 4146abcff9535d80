"""The thesis's tables 5.1 to 5.5 on regenerated data, beside the numbers it prints."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import metrics
from ._core import Sphere
from .detection import detect
from .result import Result
from .synthetic import (
    Sample,
    Surface,
    add_noise,
    mirror_fixed,
    mirror_perpendicular,
    mirror_spherical,
    remove_points,
    rotate,
    rotation_matrix,
    sphere_between,
    thin,
)
from .truth import Truth

Points = NDArray[np.float64]


@dataclass(frozen=True)
class Row:
    """One experiment: the thesis names the surfaces in its figures, the rest is chosen like it."""

    table: str
    name: str
    method: str
    make: Callable[[], Sample]
    printed: tuple[float | None, ...]
    """The thesis's figures, in the order of ``Outcome.figures``; None where it prints none."""
    damage: Callable[[Points], Points] | None = None
    rotation: tuple[float, float, float] = (0, 0, 0)
    parameters: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Outcome:
    row: Row
    points: Points
    truth: Any
    result: Result
    figures: dict[str, float]


def rows() -> Iterator[Row]:
    yield from _clean_fixed()
    yield from _clean_perpendicular("5.2", "separation_normals", _PRINTED_2)
    yield from _clean_perpendicular("5.3", "normals_only", _PRINTED_3)
    yield from _clean_spherical()
    yield from _damaged()


def measure(row: Row) -> Outcome:
    """Makes the data, finds the mirror and compares."""
    sample = row.make()
    points = sample.points if row.damage is None else row.damage(sample.points)
    truth = Truth(sample.truth, sample.pairs)
    if any(row.rotation):
        points = rotate(points, *row.rotation)
        truth = truth.moved(rotation_matrix(*row.rotation))
    result = detect(points, row.method, **row.parameters)
    if isinstance(result.mirror, Sphere):
        figures = metrics.sphere_errors(result.mirror, truth.mirror, points)._asdict()
    else:
        figures = metrics.surface_errors(result.surface_points, truth.mirror)._asdict()
        figures["coverage"] = metrics.coverage(result.surface_points, truth.mirror, points)
    return Outcome(row, points, truth.mirror, result, figures)


_PRINTED_1 = (
    (5.47e-8, 1.19e-7, 3.97e-8),
    (4.77e-8, 1.19e-7, 3.65e-8),
    (5.80e-8, 2.38e-7, 3.04e-8),
    (1.04e-7, 2.38e-7, 7.55e-8),
    (3.09e-8, 1.19e-7, 1.14e-8),
    (2.74e-8, 1.19e-7, 1.32e-8),  # its last two columns stand in each other's place
)
_PRINTED_2 = (
    (0.01, 0.05, 0.01),
    (0.04, 0.11, 0.03),
    (0.19, 0.88, 0.14),
    (0.06, 0.16, 0.05),
    (0.65, 1.06, 0.57),
    (1.05, 3.12, 0.85),
)
_PRINTED_3 = (
    (0.09, 1.06, 0.01),
    (0.29, 1.53, 0.14),
    (0.72, 2.30, 0.56),
    (0.74, 1.69, 0.47),
    (0.42, 0.94, 0.24),
    (0.40, 2.55, 0.22),
)
_PRINTED_4 = (
    (2.98e-4, 5.41e-4),
    (1.24e-4, 1.98e-4),
    (2.99e-5, 2.52e-5),
    (9.12e-4, 6.73e-4),
    (1.92e-3, 1.35e-3),
)
_FEW = {"sample_size": 100}


def _fixed(cloud: str, surface: str, shift: float) -> Callable[[], Sample]:
    extent = 0.7 if "f6" in (cloud, surface) else 2.0
    return lambda: mirror_fixed(Surface(cloud).sample(extent, 32), surface, shift)


def _waves(surface: str, extent: float, least: float, most: float, waves: int):
    return lambda: mirror_perpendicular(surface, extent, 32, least, most, waves)


def _between(cloud: str, divisor: float) -> Callable[[], Sample]:
    def make() -> Sample:
        points = Surface(cloud).sample(1.0 if cloud == "f6" else 2.0, 32)
        low, high = points.min(axis=0), points.max(axis=0)
        radius = float(np.linalg.norm(high - low)) / divisor
        sphere = sphere_between(low, high, radius)
        return mirror_spherical(points, sphere.centre, radius)

    return make


def _clean_fixed() -> Iterator[Row]:
    pairs = ("f5", "f1"), ("f1", "f2"), ("f5", "f3"), ("f1", "f4"), ("f4", "f5"), ("f1", "f6")
    for number, (pair, printed) in enumerate(zip(pairs, _PRINTED_1), start=1):
        yield Row("5.1", f"Experiment {number}", "separation", _fixed(*pair, 4.0), printed)
    yield Row(
        "5.1", "Experiment 7", "separation", _fixed("f1", "f4", 1.2), (1.05, 1.99, 0.88)
    )


def _clean_perpendicular(table: str, method: str, printed: Any) -> Iterator[Row]:
    makes = (
        _waves("f1", 2, 0.5, 0.5, 0),
        _waves("f1", 2, 0.5, 0.9, 1),
        _waves("f4", 2, 0.5, 0.9, 2),
        _waves("f5", 2, 0.5, 0.9, 2),
        _waves("f6", 1, 0.2, 0.2, 0),
        _waves("f2", 2, 0.2, 0.2, 0),
    )
    for number, (make, figures) in enumerate(zip(makes, printed), start=1):
        yield Row(table, f"Experiment {number}", method, make, figures)


def _clean_spherical() -> Iterator[Row]:
    for number, (cloud, printed) in enumerate(zip(("f6", "f1", "f5", "f4", "f3"), _PRINTED_4), 1):
        yield Row(
            "5.4",
            f"Experiment {number}",
            "sphere_thesis",
            _between(cloud, 2.5),
            printed,
            parameters=_FEW,
        )


def _damaged() -> Iterator[Row]:
    half = ((0, -9, -9), (9, 9, 9))
    corner = ((0.8, 0.8, 0), (9, 9, 9))
    damages: tuple[tuple[str, Callable[[Points], Points]], ...] = (
        ("noise everywhere", lambda points: add_noise(points, 0, 0.3, seed=1)),
        ("noise in a half", lambda points: add_noise(points, 0, 0.3, half, seed=1)),
        ("a part removed", lambda points: remove_points(points, 1, corner)),
        ("uneven density", lambda points: thin(points, 10, (0, 0, 1), seed=1)),
    )
    plane = _fixed("f5", "f1", 4.0)
    constant = _waves("f1", 2, 0.5, 0.5, 0)
    printed = {
        "separation": (
            (0.30, 1.14, 0.22),
            (0.18, 0.86, 0.10),
            (4.43e-8, 1.19e-7, 3.38e-8),
            (2.01, 2.77, 1.99),
        ),
        "separation_normals": (
            (0.22, 1.09, 0.16),
            (0.22, 1.11, 0.15),
            (1.12e-2, 4.93e-2, 7.97e-3),
            (0.89, 1.12, 0.74),
        ),
        "normals_only": (
            (0.99, 1.57, 0.89),
            (0.71, 1.58, 0.47),
            (0.36, 1.17, 0.12),
            (0.87, 1.22, 0.68),
        ),
        "sphere_thesis": ((0.30, 5.18e-2), (0.38, 0.18), (7.43e-5, 7.86e-5), (1.67e-4, 1.41e-4)),
    }
    makes = {"separation": plane, "sphere_thesis": _between("f1", 2.5)}
    for method, figures in printed.items():
        parameters = _FEW if method == "sphere_thesis" else {}
        for (name, damage), row in zip(damages, figures):
            make = makes.get(method, constant)
            yield Row("5.5", name, method, make, row, damage, parameters=parameters)
        if method.startswith("separation"):
            make = makes.get(method, constant)
            yield Row("5.5", "rotation", method, make, (None,) * 3, rotation=(10, 15, 20))
