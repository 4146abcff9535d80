"""What inspection reports of deviations: tolerance bands, and connected patches beyond them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidParameter
from ..shapes import Shape

_CELL_POINTS = 6
"""Mean number of points in a cell that holds some: then cells of one surface touch each other."""


@dataclass(frozen=True)
class Band:
    """The part of a shape whose deviation is at most a limit."""

    limit: float
    """Largest deviation, input units."""
    area: float
    """Of the points within, squared input units: a third of the faces around each; NaN of a cloud."""
    share: float
    """Of the area of all points that have a counterpart, of a cloud of their number; 0 to 1."""


@dataclass(frozen=True, eq=False)
class Patch:
    """A connected region whose deviation is above the smallest limit. The points of a mesh are connected
    by its edges, those of a cloud by neighbouring cells."""

    place: NDArray[np.float64]
    """(3,) the point with the largest deviation, input units."""
    largest: float
    """The largest deviation, input units."""
    area: float
    """Squared input units; NaN of a cloud."""
    points: NDArray[np.int64]
    """(k,) their indices, ascending."""


def limits_of(bands: ArrayLike) -> list[float]:
    """Ascending. Raises InvalidParameter for what are no positive numbers."""
    values = np.atleast_1d(np.asarray(bands, dtype=object)).ravel().tolist()
    if not values or not all(
        isinstance(value, (int, float)) and 0 < value < np.inf for value in values
    ):
        raise InvalidParameter(f"bands are {bands!r}; allowed are numbers above 0, in input units")
    return sorted(map(float, values))


def bands_within(shape: Shape, deviations: NDArray[np.float64], limits: list[float]) -> list[Band]:
    """A band for each limit; points whose deviation is NaN are not measured."""
    areas = _areas(shape)
    weights = np.ones(len(deviations)) if shape.faces is None else areas
    whole = weights[np.isfinite(deviations)].sum()
    made = []
    for limit in limits:
        inside = deviations <= limit
        share = float(weights[inside].sum() / whole) if whole > 0 else 0.0
        made.append(Band(limit, float(areas[inside].sum()), share))
    return made


def patches_above(shape: Shape, deviations: NDArray[np.float64], limit: float) -> list[Patch]:
    """The connected regions above the limit, that with the largest deviation first."""
    above = np.flatnonzero(deviations > limit)
    if not len(above):
        return []
    areas = _areas(shape)
    edges = _cell_edges(shape.points, above) if shape.faces is None else _mesh_edges(shape)
    number = np.full(len(deviations), -1)
    number[above] = np.arange(len(above))
    kept = number[edges]
    labels = _components(len(above), kept[(kept >= 0).all(axis=1)])
    order = np.argsort(labels, kind="stable")
    ends = np.flatnonzero(np.diff(labels[order])) + 1
    made = []
    for rows in np.split(above[order], ends):
        worst = rows[np.argmax(deviations[rows])]
        largest = float(deviations[worst])
        made.append(Patch(shape.points[worst], largest, float(areas[rows].sum()), rows))
    return sorted(made, key=lambda patch: (-patch.largest, patch.points[0]))


def _areas(shape: Shape) -> NDArray[np.float64]:
    """Of each point a third of the faces around it."""
    if shape.faces is None:
        return np.full(len(shape.points), np.nan)
    a, b, c = (shape.points[corner] for corner in shape.faces.T)
    thirds = np.nan_to_num(np.linalg.norm(np.cross(b - a, c - a), axis=1)) / 6
    return np.bincount(shape.faces.ravel(), np.repeat(thirds, 3), len(shape.points)).astype(float)


def _mesh_edges(shape: Shape) -> NDArray[np.int64]:
    """(k, 2) of the faces, and between copies of a point, as at the seams of textures."""
    assert shape.faces is not None
    _, first, copies = np.unique(shape.points, axis=0, return_index=True, return_inverse=True)
    seams = np.column_stack([first[copies.ravel()], np.arange(len(shape.points))])
    return np.vstack([seams, *(shape.faces[:, pair] for pair in combinations(range(3), 2))])


def _cell_edges(points: NDArray[np.float64], above: NDArray[np.int64]) -> NDArray[np.int64]:
    """(k, 2) between points of one cell of a grid and of cells that touch each other."""
    finite = points[np.isfinite(points).all(axis=1)]
    low, width = finite.min(axis=0), float(np.ptp(finite, axis=0).max()) or 1.0
    while _count(finite, low, width) * _CELL_POINTS < len(finite):
        width /= 1.2
    cells = np.floor((points[above] - low) / width).astype(np.int64)
    used, first, number = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    cell_of = {tuple(cell): i for i, cell in enumerate(used.tolist())}

    def touching() -> Iterator[tuple[int, int]]:
        for (x, y, z), i in cell_of.items():
            for dx, dy, dz in product((-1, 0, 1), repeat=3):
                if (j := cell_of.get((x + dx, y + dy, z + dz), -1)) > i:
                    yield i, j

    joined = np.array([*touching()], np.int64).reshape(-1, 2)
    own = np.column_stack([first[number.ravel()], np.arange(len(above))])
    return above[np.vstack([own, first[joined]])]


def _count(points: NDArray[np.float64], low: NDArray[np.float64], width: float) -> int:
    cells = np.floor((points - low) / width).astype(np.int64)
    steps = cells.max(axis=0) + 1
    return len(np.unique((cells[:, 0] * steps[1] + cells[:, 1]) * steps[2] + cells[:, 2]))


def _components(count: int, edges: NDArray[np.int64]) -> NDArray[np.int64]:
    """(count,) the smallest number in the component of each."""
    labels = np.arange(count)
    while True:
        low = labels[edges].min(axis=1)
        before = labels.copy()
        np.minimum.at(labels, labels[edges].ravel(), np.repeat(low, 2))
        while (labels[labels] != labels).any():
            labels = labels[labels]
        if np.array_equal(before, labels):
            return labels
