"""Distances along the edges of posed bodies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import KDTree

from .poses import Points
from .posing import Body


def geodesic_distances(
    body: Body, points: Points, starts: NDArray[np.int64]
) -> NDArray[np.float64]:
    """From some vertices to all, (starts, n), by Dijkstra. Parts of the standing body that no edge
    joins are joined where they are nearest."""
    edges = np.vstack([body.edges, *_links(body)])
    lengths = np.linalg.norm(np.subtract(*points[edges.T]), axis=1)
    return dijkstra(_graph(edges, lengths, len(points)), indices=starts)


def _graph(edges: NDArray[np.int64], lengths: NDArray[np.float64], size: int) -> coo_array:
    return coo_array((lengths, (edges[:, 0], edges[:, 1])), (size, size))


def _links(body: Body) -> list[NDArray[np.int64]]:
    edges, size = body.edges, len(body.points)
    parts = connected_components(_graph(edges, np.ones(len(edges)), size))[1]
    links = []
    for part in range(1, parts.max() + 1):
        own, others = np.flatnonzero(parts == part), np.flatnonzero(parts != part)
        away, nearest = KDTree(body.points[others]).query(body.points[own])
        ends = own[away.argmin()], others[nearest[away.argmin()]]
        links.append(np.array([ends, ends[::-1]]))
    return links
