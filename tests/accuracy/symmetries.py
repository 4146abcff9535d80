"""The point groups of parts: whole, noisy, and with a piece cut away."""

from __future__ import annotations

import time

import numpy as np

import symsurf

from .case import Case, Figures, at_least, at_most
from .poses import random_rotation
from .symmetric_parts import PARTS, cut, noisy

COUNT = 10_000  # points


def _trial(name: str, rng: np.random.Generator, damage: str) -> Figures:
    part = PARTS[name]
    points = 3 * part.sampled(COUNT, rng) @ random_rotation(rng).T + rng.normal(size=3)
    if damage == "noise":
        points = noisy(points, 0.005, rng)
    if damage == "cut":
        points = cut(points, 0.1, rng)
    start = time.process_time()
    found = symsurf.symmetries(points, threads=1)
    seconds = time.process_time() - start
    named = found.group == part.group and len(found.planes) == part.planes
    return {"named": float(named), "seconds": seconds}


BARS = {"named": at_least(1), "seconds": at_most(1)}
CASES = tuple(
    Case(
        title,
        tuple(PARTS),
        lambda name, rng, damage=damage: _trial(name, rng, damage),
        BARS,
        trials=10,
    )
    for damage, title in (
        ("", "symmetries: whole"),
        ("noise", "symmetries: noise 0.5 %"),
        ("cut", "symmetries: a tenth cut away"),
    )
)
