"""A table that is written while the files end, and gone on with where it was left."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .._core import InvalidParameter
from ..saving import write_whole
from ..saving.csv_rows import Cells, cells_of, line_of, rows_bytes, written
from .file_task import FileTask
from .result_table import POSITION, columns_of, read_table, row_from


class GrowingTable:
    """A CSV with one row per file. Whenever the process ends, it holds the rows of the files that have
    ended, and perhaps a part of one more; ``finish`` puts them in the order of the files.

    Args:
        path: of the table. Nothing is written before a file has ended.
        tasks: what is done with each file.
        positions: of each file among those of all shards; none without shards.
        resume: keep what is in the table.

    Raises:
        InvalidInput: what is there is no table of symsurf.
        InvalidParameter: it was made with other settings, or of files that are not among these.
    """

    def __init__(
        self, path: Path, tasks: Sequence[FileTask], positions: Sequence[str], resume: bool
    ) -> None:
        self._path = path
        self._positions = positions
        self._rows: dict[int, Cells] = {}
        self._columns: list[str] = []  # of the file; none: it holds nothing of this run
        if resume and path.exists():
            kept = _kept(path, tasks)
            self._rows = {index: self._positioned(index, row) for index, row in kept.items()}

    @property
    def rows(self) -> dict[int, dict[str, Any]]:
        """What the table has, by the index of the file."""
        return {index: row_from(row) for index, row in self._rows.items()}

    def add(self, index: int, row: Mapping[str, Any]) -> None:
        """Writes the row of a file: behind the others where they have its columns."""
        cells = self._rows[index] = self._positioned(index, cells_of(row))
        if cells.keys() <= set(self._columns):
            with self._path.open("r+b") as table:
                table.seek(0, 2)
                table.write(line_of(cells, self._columns))
        else:
            self.finish()

    def finish(self) -> None:
        """Writes all rows, in the order of the files."""
        rows = [self._rows[index] for index in sorted(self._rows)]
        self._columns = columns_of(rows)
        write_whole(self._path, rows_bytes(rows, self._columns))

    def _positioned(self, index: int, row: Cells) -> Cells:
        row = {name: text for name, text in row.items() if name != POSITION}
        return row | {POSITION: self._positions[index]} if self._positions else row


def _kept(path: Path, tasks: Sequence[FileTask]) -> dict[int, Cells]:
    """The rows that need not be done again, by the index of their task."""
    rows: dict[tuple[str, str], deque[Cells]] = {}
    for row in read_table(path):
        rows.setdefault((row.get("file", ""), row.get("part", "")), deque()).append(row)
    kept = {}
    for index, task in enumerate(tasks):
        part = "" if task.part is None else written(task.part)
        if left := rows.get((written(str(task.file)), part)):
            row = left.popleft()
            _require_settings(path, row, task)
            if _is_done(row, task):
                kept[index] = row
    if strangers := [file for (file, _), left in rows.items() if left]:
        raise InvalidParameter(
            f"{path} has rows of files that are not given, such as {strangers[0]}; allowed is another "
            "table, or all its files"
        )
    return kept


def _require_settings(path: Path, row: Cells, task: FileTask) -> None:
    if row.get("settings") != written(task.settings):
        raise InvalidParameter(
            f"{path} was made with {row.get('settings')!r}, which is now {task.settings!r}; allowed is "
            "another table, or the same"
        )


def _is_done(row: Cells, task: FileTask) -> bool:
    """Not what failed, what came from standard input, and what was made and is gone."""
    has_failed = "error" in row
    return not has_failed and task.content is None and all(map(Path.exists, task.outputs))
