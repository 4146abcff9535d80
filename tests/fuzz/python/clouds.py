"""Points that are hard on purpose, drawn by a generator of numpy: the same seed draws the same."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Random: TypeAlias = np.random.Generator
Points: TypeAlias = NDArray[np.float64]


def cloud(random: Random, most: int) -> Points:
    """(n, 3) with n from 4 to about ``most``; up to three times made harder."""
    count = int(np.exp(random.uniform(np.log(4), np.log(most))))
    points = one_of(SIMPLE, random)(random, count)
    for _ in range(random.integers(4)):
        points = one_of(HARDER, random)(random, points)
    return points[:most]


def faces(random: Random, count: int, is_mesh: bool) -> NDArray[np.int64] | None:
    """Triangles between so many points: none, seldom where it should be a mesh, any, or those of a
    strip."""
    kind = random.integers(4)
    if is_mesh and kind < 2:
        kind = random.integers(1, 4)
    if kind < 2 or count < 4:
        return None
    if kind == 2:
        return random.integers(count, size=(random.integers(1, 2 * count), 3))
    rows = np.arange(count - 2)
    return np.stack([rows, rows + 1 + rows % 2, rows + 2 - rows % 2], axis=1)


def one_of(choices: Any, random: Random) -> Any:
    choices = list(choices)
    return choices[random.integers(len(choices))]


def _box(random: Random, count: int) -> Points:
    return random.uniform(-1, 1, (count, 3)) * random.uniform(0.05, 1, 3)


def _sphere(random: Random, count: int) -> Points:
    points = random.normal(size=(count, 3))
    return points / np.maximum(np.linalg.norm(points, axis=1, keepdims=True), 1e-9)


def _clusters(random: Random, count: int) -> Points:
    centres = random.uniform(-1, 1, (random.integers(1, 6), 3))
    width = 10.0 ** random.integers(-12, 0)
    return centres[random.integers(len(centres), size=count)] + width * _box(random, count)


def _corner(random: Random, count: int) -> Points:
    """They crowd towards a corner: each half as far from it, or by a power."""
    if random.integers(2):
        return _box(random, count) * 2.0 ** -(np.arange(count)[:, None] % 1000)
    return random.uniform(size=(count, 3)) ** random.integers(2, 40)


def _integers(random: Random, count: int) -> Points:
    return random.integers(-random.integers(1, 10), 10, (count, 3)).astype(float)


def _grid(random: Random, count: int) -> Points:
    sides = random.integers(1, max(2, round(count ** (1 / 3)) + 1), 3)
    points = np.stack(np.meshgrid(*map(np.arange, sides), indexing="ij"), -1).reshape(-1, 3)
    return points.astype(float)


def _curve(random: Random, count: int) -> Points:
    t = np.linspace(0, 2 * np.pi, count)
    return np.stack([np.cos(t), np.sin(t), np.sin(random.integers(6) * t)], axis=1)


def _prism(random: Random, count: int) -> Points:
    sides = int(random.integers(2, 9))
    turn = 2 * np.pi * (np.arange(count) % sides) / sides
    return np.stack([np.cos(turn), np.sin(turn), (np.arange(count) // sides) / count], axis=1)


SIMPLE: tuple[Callable[[Random, int], Points], ...] = (
    _box, _sphere, _clusters, _corner, _integers, _grid, _curve, _prism
)  # fmt: skip


def _copied(random: Random, points: Points) -> Points:
    return points[random.integers(len(points), size=len(points) * random.integers(1, 4))]


def _mirrored(random: Random, points: Points) -> Points:
    images = points * np.where(np.arange(3) == random.integers(3), -1, 1)
    return np.vstack([points, images + random.integers(2) * random.normal(size=images.shape) / 1e3])


def _flattened(random: Random, points: Points) -> Points:
    """Coplanar, or, twice, collinear."""
    flat = points.copy()
    flat[:, random.permutation(3)[: random.integers(1, 3)]] = random.integers(-2, 3)
    return flat


def _turned(random: Random, points: Points) -> Points:
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    with np.errstate(all="ignore"):
        return np.asarray(points @ turn)


def _scaled(random: Random, points: Points) -> Points:
    with np.errstate(all="ignore"):
        return points * 10.0 ** random.integers(-60, 60)


def _moved(random: Random, points: Points) -> Points:
    return points + 10.0 ** random.integers(0, 17) * random.normal(size=3)


def _with_outlier(random: Random, points: Points) -> Points:
    far = points[:1] + 10.0 ** random.integers(0, 9) * random.normal(size=(1, 3))
    return np.vstack([points, far])


def _not_finite(random: Random, points: Points) -> Points:
    bad = points.copy()
    rows = random.integers(len(bad), size=random.integers(1, 4))
    bad[rows, random.integers(3)] = one_of((np.nan, np.inf, -np.inf, 1e308, 5e-324), random)
    return bad


def _rounded(random: Random, points: Points) -> Points:
    with np.errstate(all="ignore"):
        return np.round(points, int(random.integers(0, 4)))


def _noisy(random: Random, points: Points) -> Points:
    return points + 10.0 ** random.integers(-16, -1) * random.normal(size=points.shape)


HARDER: tuple[Callable[[Random, Points], Points], ...] = (
    _copied, _mirrored, _mirrored, _flattened, _turned, _turned, _scaled, _moved, _with_outlier,
    _not_finite, _rounded, _noisy,
)  # fmt: skip
