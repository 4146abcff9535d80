"""``fixed_direction`` and ``perpendicular`` on sheets around f1 to f6."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from symsurf import metrics

from . import oracle
from .case import Bar, Case, Figures, at_least, at_most, timed_detect
from .damage import falling_density, hole, noise
from .poses import Points, diagonal
from .sheets import OFFSETS, REACH, Sheets, fixed_body, fixed_sheets, perpendicular_sheets

Damaged = tuple[Points, Points]
"""What is left, and the points whose footprint should be covered."""
Damage = Callable[[Sheets, np.random.Generator], Damaged]

COVERED_WITHIN = 0.02  # of the diagonal


def none(sheets: Sheets, rng: np.random.Generator) -> Damaged:
    return sheets.points, sheets.points


def noisy(share: float) -> Damage:
    return lambda sheets, rng: (noise(sheets.points, share, rng), sheets.points)


def holed(sheets: Sheets, rng: np.random.Generator) -> Damaged:
    kept = hole(sheets.points, 0.2, rng)
    left = np.zeros(len(sheets.points), dtype=bool)
    left[kept] = True
    both = sheets.pairs[left[sheets.pairs].all(axis=1)]
    return sheets.points[kept], sheets.points[both.ravel()]


def uneven(sheets: Sheets, rng: np.random.Generator) -> Damaged:
    points = sheets.points[falling_density(sheets.points, 4, rng)]
    return points, points


def measured(method: str, sheets: Sheets, damage: Damage, rng: np.random.Generator) -> Figures:
    points, footprint = damage(sheets, rng)
    result, seconds = timed_detect(points, method)
    found = result.surface_points
    if len(found) == 0:
        return {"rms": np.inf, "max": np.inf, "coverage": 0.0, "seconds": seconds}
    distances = np.abs(sheets.truth.signed_distance(found)) / diagonal(points)
    return {
        "rms": metrics.surface_distance(found, sheets.truth, points),
        "max": float(np.nanmax(distances)),
        "coverage": metrics.coverage(found, sheets.truth, footprint, COVERED_WITHIN),
        "seconds": seconds,
    }


WAVES = (0, 1, 2, 4)  # none: a constant distance


def _fixed(name: str, bars: dict[str, Bar], damage: Damage = none, exact: bool = True) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        surface, offset = subject.split()
        waves = int(rng.choice(WAVES))
        sheets = fixed_sheets(surface, *OFFSETS[offset], waves, exact, rng)
        return measured("fixed_direction", sheets, damage, rng)

    subjects = tuple(f"{surface} {offset}" for surface in REACH for offset in OFFSETS)
    return Case(f"fixed, {name}", subjects, run, bars)


def _fixed_body(name: str, bars: dict[str, Bar], damage: Damage = none, exact: bool = True) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        surface, body = subject.split()
        return measured("fixed_direction", fixed_body(surface, body, exact, rng), damage, rng)

    subjects = ("f1 closed", "f3 closed", "f4 torus", "f5 torus")
    return Case(f"fixed, closed bodies, {name}", subjects, run, bars)


DISTANCES = {"f1": (0.25, 0.5), "f2": (0.1, 0.2), "f3": (0.25, 0.5), "f4": (0.25, 0.5),
             "f5": (0.25, 0.5), "f6": (0.15, 0.3)}  # fmt: skip


def _perpendicular(
    name: str,
    bars: dict[str, Bar],
    damage: Damage = none,
    waves: tuple[int, ...] = WAVES,
    exact: bool = True,
    subjects: tuple[str, ...] = tuple(DISTANCES),
) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        near, far = DISTANCES[subject]
        legs = int(rng.choice(waves))
        sheets = perpendicular_sheets(subject, near, far, legs, exact, rng)
        return measured("perpendicular", sheets, damage, rng)

    return Case(f"perpendicular, {name}", subjects, run, bars)


def _oracle(
    name: str,
    bars: dict[str, Bar],
    damage: Damage = none,
    waves: tuple[int, ...] = WAVES,
    exact: bool = True,
    pairs: bool = True,
) -> Case:
    """What the points of the same sheets give to one who knows the mirror nearly, and the pairs."""

    def run(subject: str, rng: np.random.Generator) -> Figures:
        near, far = DISTANCES[subject]
        sheets = perpendicular_sheets(subject, near, far, int(rng.choice(waves)), exact, rng)
        points, footprint = damage(sheets, rng)
        paired = pairs and exact and len(points) == len(sheets.points)
        surfaces = (
            oracle.from_pairs(points, sheets.pairs, sheets.points)
            if paired
            else oracle.from_layers(points, sheets.truth)
        )
        found = min(surfaces, key=lambda s: metrics.surface_distance(s, sheets.truth, points))
        return {
            "rms": metrics.surface_distance(found, sheets.truth, points),
            "coverage": metrics.coverage(found, sheets.truth, footprint, COVERED_WITHIN),
        }

    return Case(f"oracle, {name}", tuple(DISTANCES), run, bars)


def _bars(rms: float, coverage: float, **more: Bar) -> dict[str, Bar]:
    return {"rms": at_most(rms), "coverage": at_least(coverage), **more}


CASES = (
    _fixed("clean", _bars(1e-6, 0.98)),
    _fixed("noise 1 %", _bars(0.002, 0.98), noisy(0.01)),
    _fixed("noise 2 %", _bars(0.004, 0.98), noisy(0.02)),
    _fixed("20 % hole", _bars(1e-4, 0.98), holed),
    _fixed("4:1 density, some partners left", _bars(0.0008, 0.95), uneven),
    _fixed("4:1 density, no exact partners", _bars(0.0008, 0.95), uneven, exact=False),
    _fixed_body("clean", _bars(1e-6, 0.98)),
    _fixed_body("20 % hole", _bars(1e-4, 0.98), holed),
    _fixed_body("noise 1 %", _bars(0.002, 0.98), noisy(0.01)),
    _fixed_body("no exact partners", {}, exact=False),
    _perpendicular("constant distance", _bars(0.0003, 0.98, max=at_most(0.003)), waves=(0,),
                   subjects=("f1", "f4", "f5", "f6")),
    _perpendicular("1 to 4 waves", _bars(0.0005, 0.95), waves=(1, 2, 4)),
    _perpendicular("no plane separates", _bars(0.0005, 0.9), waves=(0,),
                   subjects=("f2", "f3", "f6")),
    _perpendicular("noise 1 %", _bars(0.002, 0.95), noisy(0.01)),
    _perpendicular("noise 2 %", _bars(0.004, 0.95), noisy(0.02)),
    _perpendicular("20 % hole", {}, holed),
    _perpendicular("4:1 density, some partners left", _bars(0.0015, 0.9), uneven),
    _perpendicular("4:1 density, no exact partners", _bars(0.0015, 0.9), uneven, exact=False),
    _oracle("1 to 4 waves", _bars(0.0005, 0.95), waves=(1, 2, 4)),
    _oracle("noise 1 %", _bars(0.002, 0.95), noisy(0.01)),
    _oracle("noise 1 %, unknown pairs", _bars(0.002, 0.95), noisy(0.01), pairs=False),
    _oracle("4:1 density, some partners left", _bars(0.0015, 0.9), uneven),
    _oracle("4:1 density, no exact partners", _bars(0.0015, 0.9), uneven, exact=False),
)  # fmt: skip
