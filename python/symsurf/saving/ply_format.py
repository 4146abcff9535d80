"""Binary PLY: surface points, each with its residual as MeshLab's quality; shapes with arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..results import Result
from ..shapes import Shape
from ..shapes.polygons import corners_of
from .table_format import columns_of
from .text_format import comments

_TYPES = {"f": ("double", "<f8"), "i": ("int", "<i4"), "b": ("uchar", "u1")}


def ply_bytes(result: Result) -> bytes:
    names = ("x", "y", "z", "quality")
    header = [
        "ply",
        "format binary_little_endian 1.0",
        *(f"comment {line}" for line in comments(result)),
        f"element vertex {len(result.surface_points)}",
        *(f"property double {name}" for name in names),
        "end_header",
    ]
    rows = np.column_stack([result.surface_points, result.residuals]).astype("<f8")
    return "\n".join(header).encode("ascii", "replace") + b"\n" + rows.tobytes()


def shape_ply_bytes(
    shape: Shape,
    arrays: Mapping[str, NDArray[Any]],
    face_arrays: Mapping[str, NDArray[Any]] | None = None,
) -> bytes:
    """A shape with arrays of its points and faces as properties. Arrays are (n,) or (n, 3); of these
    the properties end in _x, _y and _z."""
    columns = dict(zip("xyz", shape.points.T, strict=True)) | columns_of(arrays)
    header = ["ply", "format binary_little_endian 1.0"]
    header += [f"comment SPACE={shape.space}"] if shape.space else []
    header.append(f"element vertex {len(shape.points)}")
    header += [f"property {_TYPES[v.dtype.kind][0]} {name}" for name, v in columns.items()]
    faces = np.empty((0, 3), np.int64) if shape.faces is None else shape.faces
    of_faces = columns_of(face_arrays or {}) if len(faces) else {}
    is_long = shape.polygons is not None and np.bincount(shape.polygons).max(initial=0) > 253
    kind, length = ("int", "<i4") if is_long else ("uchar", "<u1")
    count, rows = face_rows(faces, shape.polygons, list(of_faces.values()), length, "<i4")
    if count:
        header += [f"element face {count}", f"property list {kind} int vertex_indices"]
        header += [f"property {_TYPES[v.dtype.kind][0]} {name}" for name, v in of_faces.items()]
    header.append("end_header")
    points = np.empty(
        len(shape.points), [(name, _TYPES[v.dtype.kind][1]) for name, v in columns.items()]
    )
    for name, values in columns.items():
        points[name] = values
    return "\n".join(header).encode() + b"\n" + points.tobytes() + rows


def face_rows(
    faces: NDArray[np.int64],
    polygons: NDArray[np.int64] | None,
    columns: Sequence[NDArray[Any]],
    length: str,
    corner: str,
) -> tuple[int, bytes]:
    """How many faces there are, and of each a list of its corners and what its first triangle has in
    the columns.

    Args:
        length, corner: the types of the list, as NumPy names them.
    """
    kinds = [(f"{i}", corner[0] + _TYPES[v.dtype.kind][1][-2:]) for i, v in enumerate(columns)]
    made = np.empty(len(faces), [("count", length), ("corners", corner, (3,)), *kinds])
    made["count"], made["corners"] = 3, faces
    for i, values in enumerate(columns):
        made[f"{i}"] = values
    if polygons is None:
        return len(faces), made.tobytes()
    others = made[[name for name, _ in kinds]] if kinds else None
    whole = [
        np.array(len(corners), length).tobytes()
        + np.array(corners, corner).tobytes()
        + (b"" if others is None else b"".join(value.tobytes() for value in others[row]))
        for row, corners in corners_of(faces, polygons)
    ]
    return len(whole), b"".join(whole)
