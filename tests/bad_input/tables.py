"""The tables of this folder for the hosts in Python, and parameters out of their ranges.

Without NumPy, as the Python of a host may have none.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

HERE = Path(__file__).parent
Vector = tuple[float, ...]


class Cloud(NamedTuple):
    name: str
    reason: str
    refuses_nonfinite: bool
    points: list[Vector]


class MirrorNumbers(NamedTuple):
    name: str
    kind: str
    reason: str
    numbers: dict[str, Any]
    """A number, a word, three numbers, or a table: rows of numbers."""


class File(NamedTuple):
    name: str
    reason: str
    content: bytes


def clouds() -> list[Cloud]:
    return [
        Cloud(name, reason, nonfinite == "refuse", _points(rows))
        for name, nonfinite, reason, rows in _table("clouds.tsv")
    ]


def mirrors() -> list[MirrorNumbers]:
    found = []
    for name, kind, reason, numbers in _table("mirrors.tsv"):
        entries = (entry.split("=") for entry in numbers.split(";") if entry)
        values = {key.strip(): _value(value) for key, value in entries}
        found.append(MirrorNumbers(name, kind, reason, values))
    return found


def files() -> list[File]:
    return [File(name, reason, _bytes(content)) for name, reason, content in _table("files.tsv")]


def numbers_out_of_range(parameters: Any) -> Iterator[tuple[Any, float | int]]:
    """Each integer and real of the descriptions, below and above its range, and no number."""
    for parameter in parameters:
        if parameter.type not in ("integer", "real"):
            continue
        outside = [parameter.minimum - 1, parameter.maximum + 1]
        if parameter.type == "integer":
            yield from ((parameter, int(value)) for value in outside if abs(value) < 2**31)
        else:
            finite = [value for value in outside if math.isfinite(value)]
            yield from ((parameter, value) for value in [*finite, math.nan])


def _table(name: str) -> list[list[str]]:
    heading, *rows = (HERE / name).read_text().splitlines()
    return [row.split("\t") for row in rows if len(row.split("\t")) == len(heading.split("\t"))]


def _points(rows: str) -> list[Vector]:
    points: list[Vector] = []
    for row in filter(None, rows.split(";")):
        times, _, rest = row.rpartition("*")
        first, _, step = rest.partition(" + ")
        steps = _numbers(step) or (0.0, 0.0, 0.0)
        for i in range(int(times or 1)):
            points.append(tuple(x + i * dx for x, dx in zip(_numbers(first), steps)))
    return points


def _numbers(text: str) -> Vector:
    return tuple(map(float, text.split()))


def _value(text: str) -> Any:
    try:
        rows = [_numbers(row) for row in text.split("/")]
    except ValueError:
        return text
    if len(rows) > 1:
        return rows
    row = rows[0]
    return row[0] if len(row) == 1 else row if len(row) == 3 else rows


def _bytes(text: str) -> bytes:
    def byte(match: re.Match[str]) -> str:
        code = match[1]
        return chr(int(code[1:], 16)) if code[0] == "x" else {"n": "\n", "r": "\r"}.get(code, code)

    return re.sub(r"\\(x[0-9a-f]{2}|.)", byte, text).encode("latin-1")
