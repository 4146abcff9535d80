"""Rows of texts as landmarks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from ...shapes import Landmarks

_MISSING = ("", "na", "nan", "n/a", "null", "none")
Row = tuple[int, list[str]]
"""The number of a line, from 1 on, and its cells."""


def number(text: str, line: int) -> float:
    """Of a missing value NaN. Raises InvalidInput, naming the line."""
    if text.strip().lower() in _MISSING:
        return float("nan")
    try:
        return float(text)
    except ValueError:
        raise InvalidInput(f"line {line}: {text!r:.40} is no number") from None


def is_number(text: str) -> bool:
    """Whether it is one, or stands for a missing one."""
    try:
        number(text, 0)
    except InvalidInput:
        return False
    return text.strip() != ""


def coordinates(rows: Sequence[Row], widths: tuple[int, ...] = (2, 3)) -> NDArray[np.float64]:
    """(k, 2) or (k, 3) of rows of one width. Raises InvalidInput, naming the line of another."""
    for line, cells in rows:
        if len(cells) not in widths or len(cells) != len(rows[0][1]):
            allowed = " or ".join(map(str, widths))
            raise InvalidInput(
                f"line {line}: there are {len(cells)} coordinates; allowed are {allowed}, as many in "
                "each line"
            )
    return np.array([[number(cell, line) for cell in cells] for line, cells in rows])


def landmarks_of(rows: Sequence[Row]) -> Landmarks:
    """Rows of coordinates, or of a name and coordinates. Of rows of four numbers the first is a name
    where it counts the rows, and nothing that can be known where it does not. Raises InvalidInput."""
    if not rows:
        return Landmarks(np.empty((0, 3)))
    firsts = [cells[0].strip() if cells else "" for _, cells in rows]
    is_named = not all(map(is_number, firsts))
    if not is_named and len(rows[0][1]) == 4:
        if not any(firsts == [str(i + start) for i in range(len(rows))] for start in (0, 1)):
            raise InvalidInput(
                f"line {rows[0][0]}: there are four numbers; allowed are two or three, or a name "
                "before them"
            )
        is_named = True
    if not is_named:
        return Landmarks(coordinates(rows))
    return Landmarks(coordinates([(line, cells[1:]) for line, cells in rows]), tuple(firsts))
