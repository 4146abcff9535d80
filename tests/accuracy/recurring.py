"""Meshes and clouds with parts that recur: facades with windows and gears with teeth, in any pose."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import symsurf

from .case import Case, Figures, at_least, at_most
from .poses import random_rotation
from .repeated import facade, gear
from .solids import sampled_with_triangles

SUBJECTS = {
    "facade": lambda rng, cells: facade(4, 6, rng, cells),
    "facade, even": lambda rng, cells: facade(4, 6, rng, cells, even=True),
    "facade, bars": lambda rng, cells: facade(4, 6, rng, cells, bars=True),
    "gear 7": lambda rng, cells: gear(7, rng, cells),
    "gear 24": lambda rng, cells: gear(24, rng, cells),
    "gear 24, no hole": lambda rng, cells: gear(24, rng, cells, hole=False),
}


CURVED = {
    "gear 7, curved flanks": lambda rng, cells: gear(7, rng, cells + 3, bulge=0.12),
    "gear 24, curved flanks": lambda rng, cells: gear(24, rng, cells + 3, bulge=0.12),
}


def _trial(
    subject: str,
    rng: np.random.Generator,
    noise: float,
    pure: float = 1,
) -> Figures:
    cells = int(rng.integers(1, 7))
    points, faces, label = (SUBJECTS | CURVED)[subject](rng, cells)
    points = np.exp(rng.normal()) * points @ random_rotation(rng).T + rng.normal(size=3)
    points += rng.normal(scale=noise * np.linalg.norm(np.ptp(points, axis=0)), size=points.shape)
    order = rng.permutation(len(points))
    position = np.argsort(order)
    start = time.process_time()
    found = symsurf.recurring_parts(
        points[order],
        faces=position[rng.permutation(faces)],
        threads=1,
    )
    seconds = time.process_time() - start
    return {
        "found": float(_is_right(found, label[order], pure)),
        "parts": float(len(found.parts)),
        "instances": float(len(found.transformations)),
        "score": min((each.score for each in found.transformations), default=0.0),
        "seconds": seconds,
        "points": float(len(points)),
    }


def _cloud_trial(
    subject: str,
    rng: np.random.Generator,
    noise: float,
) -> Figures:
    """Of 10^5 points. A point belongs to the window or tooth that its triangle has two corners of."""
    mesh, faces, label = SUBJECTS[subject](rng, int(rng.integers(1, 7)))
    points, triangle = sampled_with_triangles(mesh, faces, 100_000, rng)
    of_corners = np.sort(label[faces[triangle]], axis=1)
    middle = of_corners[:, 1]
    shared = (middle == of_corners[:, 2]) if "gear" in subject else np.ptp(of_corners, axis=1) == 0
    points = np.exp(rng.normal()) * points @ random_rotation(rng).T + rng.normal(size=3)
    points += rng.normal(scale=noise * np.linalg.norm(np.ptp(points, axis=0)), size=points.shape)
    start = time.process_time()
    found = symsurf.recurring_parts(points, threads=1)
    seconds = time.process_time() - start
    return {
        "found": float(_is_right(found, np.where(shared, middle, -1), 0.9)),
        "parts": float(len(found.parts)),
        "instances": float(len(found.transformations)),
        "seconds": seconds,
    }


def _is_right(found: symsurf.RecurringParts, label: NDArray[np.int64], pure: float) -> bool:
    """One part with an instance for each label, which has that share of its labelled points."""
    if len(found.parts) != 1:
        return False
    owners = []
    for each in found.parts[0]:
        labels = label[each.onto_points]
        counts = np.bincount(labels[labels >= 0], minlength=label.max() + 1)
        if counts.max() < max(1, pure * counts.sum()):
            return False
        owners.append(int(counts.argmax()))
    return sorted(owners) == list(range(label.max() + 1))


def _clouds(what: str, noise: float) -> Case:
    subjects = tuple(subject for subject in SUBJECTS if "bars" not in subject)
    return Case(f"neighbours, recurring: {what}", subjects,
                lambda subject, rng: _cloud_trial(subject, rng, noise),
                {"seconds": at_most(2)}, trials=20)  # fmt: skip


def _neighbours(what: str, subjects: tuple[str, ...], noise: float) -> Case:
    return Case(f"neighbours, recurring: {what}", subjects,
                lambda subject, rng: _trial(subject, rng, noise, pure=0.9),
                {"seconds": at_most(2)}, trials=50)  # fmt: skip


CASES = (
    Case("recurring parts", tuple(SUBJECTS), lambda subject, rng: _trial(subject, rng, 0),
         {"found": at_least(1), "score": at_least(0.9), "seconds": at_most(2)}, trials=50),
    Case("recurring parts: noise 0.01 %", tuple(SUBJECTS),
         lambda subject, rng: _trial(subject, rng, 1e-4), {"seconds": at_most(2)}, trials=50),
    _neighbours("mesh, noise 0.1 %", tuple(SUBJECTS), 1e-3),
    _neighbours("mesh, noise 0.3 %", tuple(SUBJECTS), 3e-3),
    _clouds("cloud", 0),
    _clouds("cloud, noise 0.05 %", 5e-4),
    _clouds("cloud, noise 0.1 %", 1e-3),
    _neighbours("curved flanks", tuple(CURVED), 0),
    _neighbours("curved flanks, noise 0.1 %", tuple(CURVED), 1e-3),
)  # fmt: skip
