"""Meshes with parts that recur: facades with windows and gears with teeth, in any pose."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import symsurf

from .case import Case, Figures, at_least, at_most
from .poses import random_rotation
from .repeated import facade, gear

SUBJECTS = {
    "facade": lambda rng, cells: facade(4, 6, rng, cells),
    "facade, even": lambda rng, cells: facade(4, 6, rng, cells, even=True),
    "facade, bars": lambda rng, cells: facade(4, 6, rng, cells, bars=True),
    "gear 7": lambda rng, cells: gear(7, rng, cells),
    "gear 24": lambda rng, cells: gear(24, rng, cells),
    "gear 24, no hole": lambda rng, cells: gear(24, rng, cells, hole=False),
}


def _trial(subject: str, rng: np.random.Generator, noise: float) -> Figures:
    cells = int(rng.integers(1, 7))
    points, faces, label = SUBJECTS[subject](rng, cells)
    points = np.exp(rng.normal()) * points @ random_rotation(rng).T + rng.normal(size=3)
    points += rng.normal(scale=noise * np.linalg.norm(np.ptp(points, axis=0)), size=points.shape)
    order = rng.permutation(len(points))
    position = np.argsort(order)
    start = time.process_time()
    found = symsurf.recurring_parts(
        points[order], faces=position[rng.permutation(faces)], threads=1
    )
    seconds = time.process_time() - start
    return {
        "found": float(_is_right(found, label[order])),
        "parts": float(len(found.parts)),
        "instances": float(len(found.transformations)),
        "score": min((each.score for each in found.transformations), default=0.0),
        "seconds": seconds,
        "points": float(len(points)),
    }


def _is_right(found: symsurf.RecurringParts, label: NDArray[np.int64]) -> bool:
    """One part with an instance for each label, which has points of no other."""
    if len(found.parts) != 1:
        return False
    sets = [np.unique(label[each.onto_points]) for each in found.parts[0]]
    ours = [labels[labels >= 0] for labels in sets]
    return all(len(own) == 1 for own in ours) and (
        sorted(int(own[0]) for own in ours) == list(range(label.max() + 1))
    )


CASES = (
    Case("recurring parts", tuple(SUBJECTS), lambda subject, rng: _trial(subject, rng, 0),
         {"found": at_least(1), "score": at_least(0.9), "seconds": at_most(2)}, trials=50),
    Case("recurring parts: noise 0.01 %", tuple(SUBJECTS),
         lambda subject, rng: _trial(subject, rng, 1e-4), {"seconds": at_most(2)}, trials=50),
)  # fmt: skip
