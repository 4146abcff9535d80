"""Binary PLY: surface points, each with its residual as MeshLab's quality; shapes with arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..results import Result
from ..shapes import Shape
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
    faces = np.empty((0, 3), np.int64) if shape.faces is None else shape.faces
    header = ["ply", "format binary_little_endian 1.0"]
    header += [f"comment SPACE={shape.space}"] if shape.space else []
    header.append(f"element vertex {len(shape.points)}")
    header += [f"property {_TYPES[v.dtype.kind][0]} {name}" for name, v in columns.items()]
    of_faces = columns_of(face_arrays or {}) if len(faces) else {}
    if len(faces):
        header += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
        header += [f"property {_TYPES[v.dtype.kind][0]} {name}" for name, v in of_faces.items()]
    header.append("end_header")
    rows = np.empty(
        len(shape.points), [(name, _TYPES[v.dtype.kind][1]) for name, v in columns.items()]
    )
    for name, values in columns.items():
        rows[name] = values
    kinds = [(name, _TYPES[v.dtype.kind][1]) for name, v in of_faces.items()]
    corners = np.empty(len(faces), [("count", "u1"), ("corners", "<i4", (3,)), *kinds])
    corners["count"], corners["corners"] = 3, faces
    for name, values in of_faces.items():
        corners[name] = values
    return "\n".join(header).encode() + b"\n" + rows.tobytes() + corners.tobytes()
