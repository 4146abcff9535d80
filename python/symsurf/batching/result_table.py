"""Records of files as the rows of one table."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InvalidInput, __version__
from ..saving.csv_rows import Cells, text_of
from .file_task import Record

_FIRST = ("file", "points", "unit", "method", "kind", "score", "verdict")
_LAST = ("seconds", "settings", "version", "error")
# What the table calls the statistics of an asymmetry.
_STATISTICS = {
    "matched_share": "paired_share",
    "mean": "mean",
    "rms": "rms",
    "median": "p50",
    "p95": "p95",
    "maximum": "max",
    "signed_mean": "signed_mean",
    "positive_volume": "positive_volume",
    "negative_volume": "negative_volume",
    "volume_index": "volume_index",
    "matrix": "matrix",
}
_MEASURED = tuple(_STATISTICS.values())
_LARGEST = 16  # numbers in a cell: a matrix, not the net of a surface
# Columns of words. The others hold numbers, and truth values.
_WORDS = ("file", "unit", "method", "kind", "verdict", "group", "settings", "version", "error")
POSITION = "position"
"""The column of a shard's table that says where the file stands among all: "3 of 10"."""


def row_of(record: Record) -> dict[str, Any]:
    """The row of a file. "paired_share" and the lengths from "mean" to "max" are those of the
    asymmetry, and else those of the residuals of the pairs; of vectors each component has a column,
    as "normal_x"; what is not known is missing."""
    row: dict[str, Any] = {"file": record["file"], "unit": record["unit"]}
    for name in ("part", "points", "method", "score", "verdict"):
        if name in record:
            row[name] = record[name]
    mirror = dict(record.get("mirror") or {})
    if "verdict" in record:
        row["kind"] = mirror.pop("kind", "none")
    if record.get("points"):
        row["paired_share"] = record["pairs"] / record["points"] if "pairs" in record else None
    row |= record.get("residual") or {}
    row |= _cells(mirror)
    if record["operation"] != "detect":
        statistics = record.get("statistics", {})
        row |= _cells({_STATISTICS.get(name, name): value for name, value in statistics.items()})
    row |= {name: record[name] for name in ("group", "inversion") if name in record}
    found = ("planes", "axes", "transformations")
    row |= {name: len(record[name]) for name in found if name in record}
    row |= {
        "seconds": record["seconds_in_all"],
        "settings": record["settings"],
        "version": __version__,
        "error": record.get("error", ""),
    }
    return {name: value for name, value in row.items() if value is not None}


def columns_of(rows: Iterable[Mapping[str, Any]]) -> list[str]:
    """What the rows have, and the columns that every table has, in one order for all orders of the
    rows."""
    common = (*_FIRST, *_MEASURED, *_LAST)
    own = {name for row in rows for name in row}.difference(common, [POSITION])
    position = [POSITION] if any(POSITION in row for row in rows) else []
    return [*_FIRST, *_MEASURED, *sorted(own), *position, *_LAST]


def row_from(cells: Cells) -> dict[str, Any]:
    """The row that was written as these cells."""
    row = {name: _read(name, text) for name, text in cells.items()}
    return row | {"unit": row.get("unit", ""), "error": row.get("error", "")}


def read_table(path: Path) -> list[Cells]:
    """The rows of a table, without a last one that is not whole.

    Raises InvalidInput for a file that is no table of symsurf, OSError."""
    whole, newline, _ = path.read_bytes().rpartition(b"\n")
    text = (whole + newline).decode("utf-8", "surrogateescape")
    try:
        names, *lines = csv.reader(io.StringIO(text, newline=""))
    except (ValueError, csv.Error):
        names, lines = [], []
    if lines and len(lines[-1]) < len(names):  # cut off within a name of two lines
        lines.pop()
    _require_columns(path, names)
    for number, line in enumerate(lines, 1):
        if len(line) != len(names):
            raise InvalidInput(
                f"{path}: row {number} has {len(line)} cells; the table has {len(names)} columns"
            )
    return [{name: text for name, text in zip(names, line) if text} for line in lines]


def _require_columns(path: Path, names: Sequence[str]) -> None:
    missing = [name for name in columns_of([]) if name not in names]
    if missing or len(set(names)) < len(names):
        what = f"there is no column {missing[0]}" if missing else "two columns have one name"
        raise InvalidInput(f"{path}: this is no table that symsurf has written: {what}")


def _cells(values: Mapping[str, Any]) -> dict[str, Any]:
    cells: dict[str, Any] = {}
    for name, value in values.items():
        if not isinstance(value, list):
            cells[name] = value
            continue
        array = np.asarray(value, dtype=float)
        if array.shape == (3,):
            cells |= {f"{name}_{axis}": number for axis, number in zip("xyz", array.tolist())}
        elif array.size <= _LARGEST:
            cells[name] = tuple(array.ravel().tolist())
    return cells


def _read(name: str, text: str) -> Any:
    if name in _WORDS:
        return text_of(text)
    if text in ("True", "False"):
        return text == "True"
    for number in (int, float):
        with suppress(ValueError):
            return number(text)
    return _numbers(text)


def _numbers(text: str) -> Any:
    try:
        return tuple(map(float, text.split()))
    except ValueError:
        return text
