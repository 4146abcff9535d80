"""Individuals with known asymmetry, for the tests of cohorts."""

from __future__ import annotations

import numpy as np
from symmetric_shapes import random_rotation

PAIRS = np.array([[0, 6], [1, 7], [2, 8], [3, 9], [4, 10], [5, 11]])
MIDLINE = np.array([12, 13, 14])
COUNT = 15
ROWS = ["individual", "side", "individual_side", "error"]


def relabelled(shapes):
    order = np.arange(COUNT)
    order[PAIRS] = PAIRS[:, ::-1]
    return shapes[..., order, :]


def mirrored(shapes):
    """The same over x = 0, left and right relabelled."""
    return relabelled(shapes) * np.where(np.arange(shapes.shape[-1]) == 0, -1, 1)


def symmetric_shape(rng, d=3):
    shape = rng.normal(size=(COUNT, d))
    return (shape + mirrored(shape)) / 2


def sample(rng, n=8, r=2, da=0.0, fa=0.0, me=0.0, d=3):
    """Individuals with asymmetry of known sizes, in any pose and size each."""
    base = symmetric_shape(rng, d)
    common = da * antisymmetric(rng.normal(size=(COUNT, d)))
    own = fa * antisymmetric(rng.normal(size=(n, 1, COUNT, d)))
    kind = 0.1 * rng.normal(size=(n, 1, COUNT, d))
    shapes = base + (kind + mirrored(kind)) / 2 + common + own
    shapes = shapes + me * rng.normal(size=(n, r, COUNT, d))
    return moved(shapes, rng)


def antisymmetric(shapes):
    return (shapes - mirrored(shapes)) / 2


def moved(shapes, rng):
    made = shapes.copy()
    for place in np.ndindex(shapes.shape[:2]):
        rotation = random_rotation(rng)
        if shapes.shape[-1] == 2:
            c, s = np.cos(rng.uniform(0, 6)), np.sin(rng.uniform(0, 6))
            rotation = np.array([[c, -s], [s, c]]) / np.hypot(c, s)
        made[place] = np.exp(rng.normal()) * shapes[place] @ rotation + 10 * rng.normal(
            size=shapes.shape[-1]
        )
    return made
