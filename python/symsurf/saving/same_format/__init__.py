"""A shape that was worked on, in the format of the file that it comes from: what the file holds
beside points, faces and normals stays as it is, and what cannot stay is named."""

from __future__ import annotations

from collections.abc import Callable

from .columns import rewritten_columns
from .new_shape import NewShape, Rewritten
from .obj import rewritten_obj
from .off import rewritten_off
from .ply import rewritten_ply
from .stl import rewritten_stl

__all__ = ["REWRITERS", "NewShape", "Rewritten"]

REWRITERS: dict[str, Callable[[bytes, NewShape], Rewritten]] = {
    ".ply": rewritten_ply,
    ".obj": rewritten_obj,
    ".off": rewritten_off,
    ".stl": rewritten_stl,
    ".xyz": rewritten_columns,
    ".csv": rewritten_columns,
    ".txt": rewritten_columns,
}
