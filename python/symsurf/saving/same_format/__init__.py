"""A shape that was worked on, in the format of the file that it comes from: what the file holds
beside points, faces and normals stays as it is, and what cannot stay is named."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...shapes import Shape
from ...shapes.polygons import corners_of
from ..ply_format import shape_ply_bytes
from .columns import rewritten_columns
from .glb import rewritten_glb
from .new_shape import NewShape, Rewritten, lost_arrays
from .obj import rewritten_obj
from .obj_faces import other_obj
from .off import rewritten_off
from .ply import rewritten_ply
from .splat import rewritten_splat
from .stl import rewritten_stl

__all__ = [
    "OTHER_REWRITERS",
    "REWRITERS",
    "NewShape",
    "Rewritten",
    "lost_arrays",
    "plain_content",
    "shape_bytes",
]

REWRITERS: dict[str, Callable[[bytes, NewShape], Rewritten]] = {
    ".ply": rewritten_ply,
    ".obj": rewritten_obj,
    ".off": rewritten_off,
    ".stl": rewritten_stl,
    ".xyz": rewritten_columns,
    ".csv": rewritten_columns,
    ".txt": rewritten_columns,
    ".fcsv": rewritten_columns,
    ".splat": rewritten_splat,
    ".glb": rewritten_glb,
}


OTHER_REWRITERS: dict[str, Callable[[bytes, NewShape], Rewritten]] = {
    ".ply": rewritten_ply,
    ".obj": other_obj,
    ".off": rewritten_off,
    ".splat": rewritten_splat,
}
"""Of those, the ones that take points and faces none of which are the file's."""


def plain_content(
    shape: Shape, suffix: str, face_arrays: Mapping[str, NDArray[Any]] | None = None
) -> bytes:
    """Points and faces in a format, as those that rewrite it know it, with what the faces have in
    PLY and, as the groups of those that are so, in OBJ."""
    points = [" ".join(map(repr, point)) for point in shape.points.tolist()]
    triangles = np.empty((0, 3), np.int64) if shape.faces is None else shape.faces
    polygons = corners_of(triangles, shape.polygons)
    faces = [corners for _, corners in polygons]
    if suffix == ".ply":
        return shape_ply_bytes(shape, {}, face_arrays)
    if suffix == ".obj":
        lines = [f"v {point}" for point in points]
        lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
        for name, values in (face_arrays or {}).items():  # they come last
            if values.any():
                first = int(np.argmax(values))
                before = sum(row < first for row, _ in polygons)
                lines.insert(len(points) + before, f"g {name}")
    elif suffix == ".off":
        corners = [" ".join(map(str, [len(face), *face])) for face in faces]
        lines = ["OFF", f"{len(points)} {len(faces)} 0", *points, *corners]
    elif suffix == ".stl":
        lines = ["solid"]
        for face in triangles.tolist():
            lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {points[c]}" for c in face)]
            lines += ["endloop", "endfacet"]
        lines.append("endsolid")
    else:
        separator = " " if suffix == ".xyz" else ","
        lines = [separator.join("xyz"), *(point.replace(" ", separator) for point in points)]
    return ("\n".join(lines) + "\n").encode()


def shape_bytes(shape: Shape, suffix: str) -> bytes:
    """Points and faces alone in one of these formats."""
    faces = np.empty((0, 3), np.int64) if shape.faces is None else shape.faces
    rows = np.arange(len(shape.points))
    space = shape.space.encode() if shape.space else None
    same = NewShape(
        shape.points, faces, old_faces=len(faces), sources=rows, moved=False, space=space
    )
    return REWRITERS[suffix](plain_content(shape, suffix), same).content
