"""Random poses of points and of the mirrors they were made with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from symsurf import Mirror, make_mirror

Points = NDArray[np.float64]


def random_rotation(rng: np.random.Generator) -> NDArray[np.float64]:
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


def diagonal(points: Points) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def turned(mirror: Mirror, rotation: NDArray[np.float64]) -> Mirror:
    """The mirror of the points that were turned about the origin."""
    numbers = dict(mirror.numbers)
    for name in {"surface": ("rotation", "translation"), "plane": ("normal",),
                 "cylinder": ("point", "axis")}[mirror.kind]:  # fmt: skip
        numbers[name] = rotation @ numbers[name]
    return make_mirror(mirror.kind, numbers)
