"""Points as text: x,y,z a line in CSV and TXT, x y z in XYZ."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .._core import InvalidParameter
from .whole_files import write_whole

_SEPARATORS = {".xyz": " ", ".csv": ",", ".txt": ","}


def require_points_suffix(path: Path) -> None:
    if path.suffix.lower() not in _SEPARATORS:
        allowed = ", ".join(_SEPARATORS)
        raise InvalidParameter(f"output is {str(path)!r}; allowed are the suffixes {allowed}")


def write_points(path: Path, points: np.ndarray) -> None:
    """Every digit a double holds; the file is written whole or not at all."""
    require_points_suffix(path)
    separator = _SEPARATORS[path.suffix.lower()]
    lines = (separator.join(map(repr, row)) for row in points.tolist())
    write_whole(path, ("\n".join(lines) + "\n").encode())
