"""A scene as its parts, each a shape of its own."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput, InvalidParameter
from ..base.optional import require
from ..base.options import Reading
from ..shapes import Shape
from .inputs import as_input

CONNECTED = "connected"
_LEAST = 10  # points of a part: what methods need
_CROWD = 9  # points of a cell about three spacings wide


def parts_of(
    given: Any,
    parts: str | ArrayLike,
    faces: ArrayLike | None = None,
    reading: Reading | None = None,
    **rows: ArrayLike | None,
) -> list[Shape]:
    """The parts with at least 10 finite points: connected ones in the order of their first points,
    labelled ones by ascending label.

    Args:
        given, faces, reading: as of ``as_input``.
        parts: "connected", the name of a point array of a data set, a table or a file that PyVista
            reads, or (n,) labels; points whose label is NaN belong to none.
        rows: normals (n, 3) and weights (n,), in place of those of the shape, to be split, too.

    Raises:
        InvalidParameter: an unknown array; labels that are not one per point.
        InvalidInput: no part has 10 points.
    """
    known = as_input(given, faces, reading)
    points = np.asarray(known.points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise InvalidInput(f"points have shape {points.shape}; allowed is (n, 3)")
    whole = known.as_shape(points)
    own: dict[str, Any] = {
        name: np.asarray(each, float) for name, each in rows.items() if each is not None
    }
    for name, each in own.items():
        if len(each) != len(points):
            raise InvalidInput(f"{len(each)} {name} are given for {len(points)} points")
    whole = replace(whole, **own)
    is_connected = isinstance(parts, str) and parts == CONNECTED
    if is_connected:
        labels = _connected(points, known.faces)
    else:
        labels = np.asarray(named_array(given, parts) if isinstance(parts, str) else parts)
    if labels.shape != (len(points),):
        raise InvalidParameter(
            f"parts have shape {labels.shape}; allowed is one label per point, ({len(points)},)"
        )
    _, first, number = np.unique(labels, return_index=True, return_inverse=True)
    counted = np.isfinite(points).all(axis=1)
    if is_connected:
        counted &= labels >= 0
    elif labels.dtype.kind == "f":
        counted &= ~np.isnan(labels)
    sizes = np.bincount(number[counted])
    chosen = np.flatnonzero(sizes >= _LEAST)
    if is_connected:
        chosen = chosen[np.argsort(first[chosen])]
    found = [_rows(whole, (number == k) & counted) for k in chosen]
    if not found:
        raise InvalidInput(
            f"no part has {_LEAST} points; the largest has {sizes.max(initial=0)} of {len(points)}"
        )
    return found


def _rows(shape: Shape, chosen: NDArray[np.bool_]) -> Shape:
    faces = shape.faces
    if faces is not None:
        faces = (np.cumsum(chosen) - 1)[faces[chosen[faces].all(axis=1)]]
    names = ("normals", "colours", "weights")
    rows: dict[str, Any] = {
        name: each[chosen] for name in names if (each := getattr(shape, name)) is not None
    }
    return Shape(shape.points[chosen], faces, space=shape.space, **rows)


def named_array(given: Any, name: str) -> NDArray[Any]:
    """A point array of a data set, a table or a file. Raises InvalidParameter, listing the names."""
    data = given
    if isinstance(given, (str, os.PathLike)):
        data = require("parts by an array of a file", "pyvista").read(given)
    arrays = getattr(data, "point_data", data)
    names = list(arrays.keys()) if hasattr(arrays, "keys") else []
    if name not in names:
        allowed = ", ".join([CONNECTED, *map(str, names)])
        raise InvalidParameter(f"parts is {name!r}; allowed are {allowed}")
    return np.asarray(arrays[name])


def _connected(points: NDArray[np.float64], faces: NDArray[np.int64] | None) -> NDArray[np.int64]:
    """(n,) a point of the part of each; -1 for points of no face, or not finite."""
    if faces is not None and len(faces):
        # Corners of triangles that nobody merged are equal points.
        _, first, place = np.unique(points, axis=0, return_index=True, return_inverse=True)
        place = place.ravel()
        labels = first[_joined(place[faces], len(first))][place]
        labels[np.setdiff1d(np.arange(len(points)), faces)] = -1
        return labels
    labels = np.full(len(points), -1)
    finite = np.flatnonzero(np.isfinite(points).all(axis=1))
    if len(finite):
        cells, first, place = _cells(points[finite])
        labels[finite] = finite[first[_joined(_neighbours(cells), len(cells))][place.ravel()]]
    return labels


def _joined(links: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """(count,) the least number in the part of each that the rows of links hold together."""
    least = np.arange(count)
    while True:
        found = least.copy()
        of_links = least[links]
        lowest = np.broadcast_to(of_links.min(axis=1, keepdims=True), links.shape)
        np.minimum.at(found, of_links, lowest)
        found = found[found]
        if (found == least).all():
            return least
        least = found


def _cells(points: NDArray[np.float64]) -> tuple[NDArray[np.int64], ...]:
    """The cells of a grid with points in them, the first point of each, and each point's cell."""
    low, extent = points.min(axis=0), np.ptp(points, axis=0).max()
    coarse, fine = 0.0, 20.0  # cells along the longest side, as powers of 2
    for _ in range(12):
        middle = (coarse + fine) / 2
        cells = np.floor((points - low) * (2**middle / max(extent, 1e-300))).astype(np.int64)
        count = len(np.unique(cells, axis=0))
        coarse, fine = (middle, fine) if count * _CROWD < len(points) else (coarse, middle)
    return np.unique(cells, axis=0, return_index=True, return_inverse=True)


def _neighbours(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """(m, 2) the cells that touch, in a corner at least."""
    number = {tuple(cell): k for k, cell in enumerate(cells.tolist())}
    ways = [way for way in np.ndindex(3, 3, 3) if way > (1, 1, 1)]
    return np.array(
        [
            (k, other)
            for (x, y, z), k in number.items()
            for i, j, l in ways
            if (other := number.get((x + i - 1, y + j - 1, z + l - 1))) is not None
        ],
        dtype=np.int64,
    ).reshape(-1, 2)
