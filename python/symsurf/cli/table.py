"""symsurf table: what is done with tables of many files."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._core import InvalidParameter
from ..batching.result_table import columns_of
from ..batching.shards import merged
from ..saving import write_whole
from ..saving.csv_rows import rows_bytes
from .output_paths import add_output, require_suffix
from .terminal import complain

SUMMARY = "Merges the tables of shards."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    commands = parser.add_subparsers(required=True, metavar="KIND")
    summary = (
        "Merges tables: those of shards into the table of one run, others one after the other."
    )
    merge = commands.add_parser("merge", help=summary, description=summary, allow_abbrev=False)
    merge.add_argument("tables", nargs="+", type=Path, metavar="TABLE", help="what --table wrote")
    add_output(merge, type=Path, required=True, metavar="FILE", help="the table of all, a CSV")


def run(arguments: argparse.Namespace) -> int:
    output: Path = arguments.output
    require_suffix("output", output, ".csv")
    if output.resolve() in {table.resolve() for table in arguments.tables}:
        raise InvalidParameter(f"{output} would overwrite an input; allowed is another name")
    rows, missing = merged(arguments.tables)
    output.parent.mkdir(parents=True, exist_ok=True)
    write_whole(output, rows_bytes(rows, columns_of(rows)))
    if missing:
        complain(f"{output}: {missing} of {missing + len(rows)} files are missing")
    return 1 if missing else 0
