"""Records of files as the rows of one table."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._core import __version__
from .file_task import Record

_FIRST = ("file", "points", "unit", "method", "kind", "score", "verdict")
_LAST = ("seconds", "version", "error")
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
# What begins one, by OWASP's page on CSV injection.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "\uff1d", "\uff0b", "\uff0d", "\uff20")
_LARGEST = 16  # numbers in a cell: a matrix, not the net of a surface


def row_of(record: Record) -> dict[str, Any]:
    """The row of a file. "paired_share" and the lengths from "mean" to "max" are those of the
    asymmetry, and else those of the residuals of the pairs; of vectors each component has a column,
    as "normal_x"; what is not known is missing."""
    row: dict[str, Any] = {"file": record["file"], "unit": record["unit"]}
    for name in ("points", "method", "score", "verdict"):
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
        "version": __version__,
        "error": record.get("error", ""),
    }
    return {name: value for name, value in row.items() if value is not None}


def columns_of(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """What the rows have, and the columns that every table has, in one order."""
    own = dict.fromkeys(name for row in rows for name in row)
    common = {*_FIRST, *_MEASURED, *_LAST}
    return [*_FIRST, *_MEASURED, *(name for name in own if name not in common), *_LAST]


def csv_bytes(rows: Sequence[Mapping[str, Any]]) -> bytes:
    """The table, comma-separated, with a row of names; file names keep their bytes."""
    text = io.StringIO()
    writer = csv.DictWriter(text, columns_of(rows), restval="", lineterminator="\n")
    writer.writeheader()
    for row in rows:
        writer.writerow({name: _written(value) for name, value in row.items()})
    return text.getvalue().encode("utf-8", "surrogateescape")


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


def _written(value: Any) -> Any:
    """Every digit of a number, those of a matrix row by row; nothing for what is no number. A text
    that a spreadsheet would take for a formula begins with an apostrophe."""
    if isinstance(value, float) and math.isnan(value):
        return ""
    if isinstance(value, str) and value.startswith(_FORMULA):
        return f"'{value}"
    return " ".join(map(repr, value)) if isinstance(value, tuple) else value
