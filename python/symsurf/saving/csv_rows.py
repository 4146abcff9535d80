"""Rows of values as CSV, which spreadsheets may read: no text of a file becomes a formula."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeAlias

# What begins one, by OWASP's page on CSV injection.
_FORMULA = "=+\\-@\t\r\n\uff1d\uff0b\uff0d\uff20"
# Where a cell begins: a spreadsheet may take semicolons, as it does in many countries, or tabs for what
# separates them.
_START = re.compile(f"(^|[;\t])(?=[{_FORMULA}])")
_MARKED = re.compile(f"(^|[;\t])'(?=[{_FORMULA}])")

Cells: TypeAlias = dict[str, str]
"""A row as it is written: the text of each cell that has one, by the name of the column."""


def cells_of(row: Mapping[str, Any]) -> Cells:
    """The row as it is written."""
    return {name: text for name, value in row.items() if (text := written(value))}


def written(value: Any) -> str:
    """Every digit of a number, those of a matrix row by row; nothing for what is no number. A text
    that a spreadsheet would take for a formula begins with an apostrophe, and so does what would be one
    behind a semicolon or a tab."""
    if isinstance(value, float) and math.isnan(value):
        return ""
    if isinstance(value, str):
        return _START.sub(r"\1'", value)
    return " ".join(map(repr, value)) if isinstance(value, tuple) else str(value)


def text_of(cell: str) -> str:
    """The text that was written so."""
    return _MARKED.sub(r"\1", cell)


def rows_bytes(rows: Iterable[Cells], columns: Sequence[str]) -> bytes:
    """The table, comma-separated, with a row of names; file names keep their bytes."""
    return b"".join([_line(columns), *(line_of(row, columns) for row in rows)])


def line_of(row: Cells, columns: Sequence[str]) -> bytes:
    return _line([row.get(name, "") for name in columns])


def _line(cells: Sequence[str]) -> bytes:
    text = io.StringIO()
    # Quotes a carriage return too, which ends lines for those who read.
    csv.writer(text, lineterminator="\r\n").writerow(cells)
    return (text.getvalue().removesuffix("\r\n") + "\n").encode("utf-8", "surrogateescape")
