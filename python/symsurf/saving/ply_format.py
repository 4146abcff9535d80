"""Surface points as binary PLY, each with its residual as MeshLab's quality."""

from __future__ import annotations

import numpy as np

from ..result import Result
from .text_format import figures


def ply_bytes(result: Result) -> bytes:
    names = ("x", "y", "z", "quality")
    header = [
        "ply",
        "format binary_little_endian 1.0",
        *(f"comment {name} {text}" for name, text in figures(result)),
        f"element vertex {len(result.surface_points)}",
        *(f"property double {name}" for name in names),
        "end_header",
    ]
    rows = np.column_stack([result.surface_points, result.residuals]).astype("<f8")
    return "\n".join(header).encode("ascii", "replace") + b"\n" + rows.tobytes()
