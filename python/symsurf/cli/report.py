"""symsurf report: pages about the asymmetry of files."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._core import operations
from ..batching.file_task import Record
from ..batching.report_files import report_tasks, write_report
from ..report import require_viewer
from ..results.summary import of_the_diagonal
from .batch_options import add_files, add_mirror_options, add_table_options, input_tasks, run_tasks
from .described_options import add_parameters, given_values
from .output_paths import add_output
from .terminal import say

SUMMARY = "Writes an HTML page with each shape, its mirror and its asymmetry, in 3D and in figures."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_files(parser)
    add_output(
        parser,
        type=Path,
        required=True,
        metavar="FILE",
        help="the page, HTML, which needs nothing but itself; of several files the percentiles over "
        "all of them, with a page each in the folder FILE_files beside it",
    )
    add_table_options(parser)
    add_mirror_options(parser)
    add_parameters(parser, operations()["asymmetry"])


def run(arguments: argparse.Namespace) -> int:
    require_viewer()
    asked = input_tasks(arguments, given_values(arguments), require_found=arguments.require_found)
    tasks = report_tasks(asked, arguments.output)
    status, rows = run_tasks(tasks, arguments, _text)
    write_report(arguments.output, tasks, rows)
    if len(tasks) > 1:
        say(f"  written   {arguments.output}")
    return status


def _text(record: Record) -> str:
    rms = of_the_diagonal(record["statistics"]["rms_of_diagonal"])
    kind = record["mirror"]["kind"]
    return (
        f"{record['file']}: {record['verdict']}, {kind}, score {record['score']:.3f}, asymmetry "
        f"{rms}"
    )
