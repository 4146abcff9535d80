"""PTS: the program Landmark's, and plain rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..._core import InvalidInput
from ...shapes import Landmarks
from ..location import text_of
from .rows import Row, landmarks_of

_MISSING = 9999.0  # each coordinate of what was not placed in Landmark


def read(path: Path) -> list[Landmarks]:
    """Rows of coordinates, or of a name and coordinates. Before them may stand the version, and how
    many there are; around them braces."""
    lines = [
        (n, line.split())
        for n, line in enumerate(text_of(path).splitlines(), 1)
        if line.strip() and line.strip() not in "{}" and not line.lstrip().startswith("#")
    ]
    versioned = bool(lines) and lines[0][1][0].lower().startswith("version")
    count, rows = _counted(lines[1:] if versioned else lines)
    if count is not None and count != len(rows):
        raise InvalidInput(f"there are {len(rows)} landmarks; the file promises {count}")
    found = landmarks_of(rows)
    if versioned:
        found.points[(found.points == _MISSING).all(axis=1)] = np.nan
    return [found]


def _counted(lines: list[Row]) -> tuple[int | None, list[Row]]:
    """How many rows are promised, and the rows."""
    if lines:
        words = lines[0][1]
        is_count = len(words) == 1 or words[0].lower().startswith("n_points")
        if is_count and words[-1].isdecimal():
            return int(words[-1]), lines[1:]
    return None, lines
