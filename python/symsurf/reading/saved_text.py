"""Reading the thesis's output file back."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, Sphere


@dataclass(frozen=True, eq=False)
class SavedText:
    """What a file that ``Result.save("….txt")`` wrote says."""

    figures: dict[str, str]
    """The lines after #, by their first word."""
    surface_points: NDArray[np.float64]
    """(m, 3); none where the result is a sphere."""
    sphere: Sphere | None = None


def read_text(path: str | os.PathLike[str]) -> SavedText:
    """Reads figures after #, then x,y,z a line; a sphere as its centre, then its radius.

    Raises InvalidInput naming the file and the line.
    """
    path = Path(path)
    try:
        lines = path.read_text().splitlines()
    except OSError as error:
        raise InvalidInput(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InvalidInput(f"{path}: {error}") from error
    figures: dict[str, str] = {}
    rows: list[list[float]] = []
    for number, line in enumerate(lines, start=1):
        if line.startswith("#"):
            name, _, text = line[1:].strip().partition(" ")
            figures[name] = text
        elif line.strip():
            rows.append(_numbers(line, path, number))
    if len(rows) == 2 and [len(row) for row in rows] == [3, 1]:
        return SavedText(figures, np.empty((0, 3)), Sphere(rows[0], rows[1][0]))
    for row in rows:
        if len(row) != 3:
            raise InvalidInput(f"{path}: {len(row)} numbers where x,y,z is expected")
    return SavedText(figures, np.array(rows, dtype=float).reshape(-1, 3))


def _numbers(line: str, path: Path, number: int) -> list[float]:
    try:
        return [float(part) for part in line.split(",")]
    except ValueError as error:
        raise InvalidInput(f"{path}, line {number}: {line!r:.40} is not x,y,z") from error
