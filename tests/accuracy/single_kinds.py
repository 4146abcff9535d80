"""Methods for one kind of mirror on the cases of the benchmark of curved mirrors."""

from __future__ import annotations

import numpy as np

from symsurf.benchmark import benchmark

from .bodies import image_errors
from .case import Case, Figures, at_most, timed_detect

SHAPES = ("creature", "head", "part", "mask", "sheets")
DAMAGES = ("exact", "clean", "noise-1", "hole", "density")
BENDS = {
    "sphere": ("domed",),
    "cylinder": ("bent",),
    "quadric": ("bent", "domed", "twisted"),
    "perpendicular": ("bent", "domed", "waved", "twisted"),
}
NEAR = {"exact": 1e-3, "clean": 5e-3}  # of the diagonal, between images and true ones
NEAR_DAMAGED = 0.01


def _case(method: str, damage: str) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        name = f"{subject.replace(' ', '-')}-{damage}"
        sample = next(benchmark("small", int(rng.integers(2**31)), [name]))
        result, seconds = timed_detect(sample.points, method)
        if result.mirror is None:
            return {"image error": np.inf, "seconds": seconds}
        errors = image_errors(result.mirror, sample.points, sample.images)
        return {"image error": float(np.median(errors)), "score": result.score, "seconds": seconds}

    subjects = tuple(f"{shape} {bend}" for shape in SHAPES for bend in BENDS[method])
    bars = {"image error": at_most(NEAR.get(damage, NEAR_DAMAGED))}
    return Case(f"{method}, benchmark, {damage}", subjects, run, bars)


CASES = tuple(_case(method, damage) for method in BENDS for damage in DAMAGES)
