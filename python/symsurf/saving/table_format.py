"""What an operation gives each point, without the points: as CSV and as NumPy's own format."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO, StringIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..results import Correspondences
from ..shapes.columns import columns_of


def npy_bytes(arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """A structured array, one row per point and one field per array."""
    kinds = [(name, values.dtype, values.shape[1:]) for name, values in arrays.items()]
    count = len(next(iter(arrays.values()))) if arrays else 0
    rows = np.empty(count, kinds)
    for name, values in arrays.items():
        rows[name] = values
    file = BytesIO()
    np.save(file, rows, allow_pickle=False)
    return file.getvalue()


def csv_bytes(arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """A line of names, then one line per point, every digit a double holds; booleans as 0 and 1, rows of
    three as columns that end in _x, _y and _z, others numbered from 0."""
    columns = columns_of(arrays)
    file = StringIO()
    file.write(",".join(columns) + "\n")
    lists = [
        (values.astype(int) if values.dtype.kind == "b" else values).tolist()
        for values in columns.values()
    ]
    file.writelines(",".join(map(repr, row)) + "\n" for row in zip(*lists, strict=True))
    return file.getvalue().encode()


def mirror_bytes(result: Correspondences) -> bytes:
    """MakeHuman's table: one line for each point that has one: its number, that of its mirror point, and l, r
    or m: on the side where signed distances are greater, on the other, or its own mirror point."""
    points = np.flatnonzero(result.index >= 0)
    partners = result.index[points]
    # A pose may have put both on one side of the mirror.
    distances = result.mirror.signed_distance(result.shape.points)
    is_left = distances[points] > distances[partners]
    sides = np.where(partners == points, "m", np.where(is_left, "l", "r"))
    rows = zip(points.tolist(), partners.tolist(), sides.tolist(), strict=True)
    return "".join(f"{point} {partner} {side}\n" for point, partner, side in rows).encode()
