"""Polygons, as the fans of triangles that stand for them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .shape import Shape


def fans(polygons: NDArray[np.int64]) -> Iterator[range]:
    """The triangles of each polygon: the rows that follow each other with one number."""
    starts = np.flatnonzero(np.diff(polygons, prepend=-1, append=-1)).tolist()
    return (range(*pair) for pair in pairwise(starts))


def corners_of(
    faces: NDArray[np.int64], polygons: NDArray[np.int64] | None
) -> list[tuple[int, list[int]]]:
    """The polygons as their corners, from the one that their triangles share on, each with the row of its
    first triangle."""
    rows = faces.tolist()
    if polygons is None:
        return list(enumerate(rows))
    found = []
    for fan in fans(polygons):
        polygon = _joined([rows[row] for row in fan])
        if polygon is None:
            found += [(row, rows[row]) for row in fan]
        else:
            found.append((fan.start, polygon))
    return found


def carried_polygons(
    faces: NDArray[np.int64],
    face_sources: NDArray[np.int64],
    point_sources: NDArray[np.int64],
    given: Shape,
) -> NDArray[np.int64] | None:
    """The polygons of new faces: of those that are copies or images of all triangles of a given one, in
    their order.

    Args:
        face_sources: (m,) the triangle of the given shape that each is a part or an image of.
        point_sources: (n,) the given point that each is or is an image of; -1 for others.
    """
    polygons = given.polygons
    if polygons is None or given.faces is None or np.array_equal(faces, given.faces):
        return polygons
    sizes = np.bincount(polygons)[polygons][face_sources].tolist()
    corners = np.sort(point_sources[faces], axis=1), np.sort(given.faces[face_sources], axis=1)
    is_image = (corners[0] == corners[1]).all(axis=1)
    follows = np.diff(face_sources, prepend=-1) == 1
    follows[1:] &= np.diff(polygons[face_sources]) == 0
    rows = faces.tolist()
    made = np.arange(len(faces))
    row = 0
    while row < len(faces):
        fan = slice(row, row + sizes[row])
        is_whole = is_image[fan].all() and follows[row + 1 : fan.stop].all()
        if is_whole and 1 < sizes[row] == len(rows[fan]) and _joined(rows[fan]):
            made[fan] = row
            row = fan.stop
        else:
            row += 1
    return None if np.array_equal(made, np.arange(len(faces))) else made


def _joined(triangles: list[list[int]]) -> list[int] | None:
    """The polygon of triangles, each of which has an edge of those before; None where that is no fan."""
    polygon, *rest = triangles
    for a, b, c in rest:
        for one, two, new in ((a, b, c), (b, c, a), (c, a, b)):
            at = polygon.index(two) if two in polygon else -1
            if at >= 0 and polygon[(at + 1) % len(polygon)] == one and new not in polygon:
                polygon = [*polygon[: at + 1], new, *polygon[at + 1 :]]
                break
        else:
            return None
    apexes = set(triangles[0]).intersection(*triangles[1:])
    first = next((corner for corner in triangles[0] if corner in apexes), None)
    if first is None:
        return None
    at = polygon.index(first)
    return polygon[at:] + polygon[:at]
