"""Tables: CSV, and 3D Slicer's FCSV."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path

from ..._core import InvalidInput
from ...shapes import Landmarks
from ...shapes.space import space_in
from ..location import text_of
from .rows import Row, coordinates, landmarks_of

_NAMES = ("name", "label", "landmark", "id")
_FCSV_COLUMNS = ("label", "x", "y", "z")  # of files older than their line of names


def read_csv(path: Path) -> list[Landmarks]:
    """Columns named x, y and z with one of names, or rows of coordinates, with a name before them or
    without; commas, semicolons (then with decimal commas) or tabs between."""
    rows = _cells(text_of(path))
    if not rows:
        return []
    titles = [re.sub(r"[\[(].*", "", cell).strip().lower() for cell in rows[0][1]]
    if {"x", "y"} <= set(titles):
        return [_by_columns(titles, rows[1:])]
    return [landmarks_of(rows)]


def read_fcsv(path: Path) -> list[Landmarks]:
    """In the axes that the file names; the columns by its line of names."""
    text = text_of(path)
    named = re.search(r"^#\s*columns\s*=(.*)$", text, re.MULTILINE)
    columns = _FCSV_COLUMNS if named is None else [c.strip() for c in named[1].split(",")]
    found = _by_columns(columns, _cells(text))
    return [Landmarks(found.points, found.names, space_in(text.encode()) or "")]


def _cells(text: str) -> list[Row]:
    """The rows that are no comments and not empty."""
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip(" \t;,")]
    lines = [(n, line) for n, line in lines if not line.startswith("#")]
    if not lines:
        return []
    between = next((mark for mark in "\t;" if mark in lines[0][1]), ",")
    rows = [
        (n, next(csv.reader([line], delimiter=between, skipinitialspace=True))) for n, line in lines
    ]
    if between == ",":
        return rows
    return [(n, [re.sub(r"^(-?\d*),(\d)", r"\1.\2", c.strip()) for c in row]) for n, row in rows]


def _by_columns(titles: Sequence[str], rows: Sequence[Row]) -> Landmarks:
    axes = [titles.index(axis) for axis in "xyz" if axis in titles]
    if len(axes) < 2:
        raise InvalidInput(f"the columns are {', '.join(titles)}; allowed are some with x and y")
    for line, cells in rows:
        if len(cells) <= max(axes):
            raise InvalidInput(f"line {line}: there are {len(cells)} columns; the last is missing")
    points = coordinates([(line, [cells[axis] for axis in axes]) for line, cells in rows])
    for column in (titles.index(name) for name in _NAMES if name in titles):
        names = tuple(cells[column].strip() if column < len(cells) else "" for _, cells in rows)
        if all(names):
            return Landmarks(points, names)
    return Landmarks(points)
