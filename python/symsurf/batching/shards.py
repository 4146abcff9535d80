"""Shares of many files for the jobs of an array, and one table of their tables."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from .._core import InvalidInput, InvalidParameter
from ..saving.csv_rows import Cells
from .result_table import POSITION, read_table


class Shard(NamedTuple):
    """One of several jobs, counted from 1."""

    number: int
    jobs: int

    def indices(self, files: int) -> range:
        """Of the files that it works on: every ``jobs``-th."""
        return range(self.number - 1, files, self.jobs)


def shard_from(text: str) -> Shard:
    """The shard that is written "I/N". Raises InvalidParameter."""
    found = re.fullmatch(r"(\d{1,9})/(\d{1,9})", text, re.ASCII)
    shard = Shard(*map(int, found.groups())) if found else Shard(0, 0)
    if not 1 <= shard.number <= shard.jobs:
        raise InvalidParameter(
            f"shard is {text!r}; allowed is I/N, the I-th of N, with I from 1 to N: a job array counts "
            "from 1, as in --array=1-8"
        )
    return shard


def positions(shard: Shard, files: int) -> list[str]:
    """Where each file of the shard stands among all, for the column of that name."""
    return [f"{index + 1} of {files}" for index in shard.indices(files)]


def merged(tables: Sequence[Path]) -> tuple[list[Cells], int]:
    """The rows of all tables, and how many are not there: those of shards in the order of one run,
    others one table after the other.

    Raises:
        InvalidInput: what is no table of symsurf; tables of other settings, or of files that another
            has; shards of several runs.
        OSError: a table cannot be read.
    """
    rows = {table: read_table(table) for table in tables}
    _require_same_settings(rows)
    every = [(table, row) for table, its in rows.items() for row in its]
    _require_once(every, "file")
    sharded = [(table, row) for table, row in every if POSITION in row]
    if not sharded:
        return [row for _, row in every], 0
    if len(sharded) < len(every):
        whole = next(table for table, row in every if POSITION not in row)
        raise InvalidInput(
            f"{whole} has no column {POSITION}, but {sharded[0][0]} has; allowed are shards of one run, "
            "or whole tables"
        )
    _require_once(sharded, POSITION)
    return _in_order(sharded)


def _require_same_settings(rows: dict[Path, list[Cells]]) -> None:
    made = {row.get("settings", ""): table for table, its in rows.items() for row in its}
    if len(made) > 1:
        (one, first), (other, second) = list(made.items())[:2]
        raise InvalidInput(
            f"{first} was made with {one!r}, but {second} with {other!r}: their columns clash; allowed "
            "are tables that were made alike"
        )


def _require_once(rows: Sequence[tuple[Path, Cells]], column: str) -> None:
    """No two tables may have one row; one table has a file twice where it was given twice."""
    first: dict[str, Path] = {}
    for table, row in rows:
        value = row.get(column, "")
        if first.setdefault(value, table) != table:
            raise InvalidInput(
                f"{column} {value} is in {first[value]} and in {table}; allowed is each file once"
            )


def _in_order(rows: Sequence[tuple[Path, Cells]]) -> tuple[list[Cells], int]:
    placed: dict[int, Cells] = {}
    counts: dict[int, Path] = {}
    for table, row in rows:
        index, count = _position_of(table, row)
        counts.setdefault(count, table)
        placed[index] = {name: text for name, text in row.items() if name != POSITION}
    if len(counts) > 1:
        (one, first), (other, second) = list(counts.items())[:2]
        raise InvalidInput(
            f"{first} is of a run of {one} files, but {second} of one of {other}; allowed are shards "
            "of one run"
        )
    return [placed[index] for index in sorted(placed)], next(iter(counts)) - len(placed)


def _position_of(table: Path, row: Cells) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,9}) of (\d{1,9})", row[POSITION], re.ASCII)
    if found is None:
        raise InvalidInput(
            f"{table}: {POSITION} is {row[POSITION]!r}; allowed is such as '3 of 10'"
        )
    index, count = map(int, found.groups())
    return index, count
