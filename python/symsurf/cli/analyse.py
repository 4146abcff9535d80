"""symsurf symmetries, ...: a command for each analysis, made from its description."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from .._core import Analysis, InvalidParameter
from ..batching.file_task import FileTask, Record
from ..results import Symmetries
from ..saving import ANALYSIS_FORMATS
from .batch_options import (
    add_absolute,
    add_batch_options,
    add_files,
    input_tasks,
    jobs_and_threads,
    planned_outputs,
    run_tasks,
    tell,
    worked_on,
)
from .described_options import add_parameters, given_values
from .values import shown


class AnalysisCommand:
    """What symsurf.cli takes for a command."""

    def __init__(self, analysis: Analysis) -> None:
        self._analysis = analysis
        self.SUMMARY = analysis.summary
        self._has_bop = analysis.name == Symmetries.analysis

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        add_files(parser)
        parser.add_argument(
            "--output",
            type=Path,
            metavar="DIR",
            help="write what is found to DIR, a file for each",
        )
        parser.add_argument(
            "--format",
            default="json",
            metavar="WORD",
            help=f"of --output: {' or '.join(name[1:] for name in ANALYSIS_FORMATS)}; json holds all "
            "that is found, ply and vtp the shape with what the analysis gives each point; default "
            "%(default)s",
        )
        if self._has_bop:
            parser.add_argument(
                "--bop",
                action="store_true",
                help="print one JSON object: for each file an entry of the BOP toolkit's models_info, "
                "with symmetries_discrete and symmetries_continuous",
            )
        add_batch_options(parser)
        add_absolute(parser)
        add_parameters(parser, self._analysis)

    def run(self, arguments: argparse.Namespace) -> int:
        given = input_tasks(arguments)
        outputs = planned_outputs(arguments, given, lambda _: [_output_suffix(arguments.format)])
        _, threads = jobs_and_threads(arguments)
        tasks = [
            replace(
                task,
                operation=self._analysis.name,
                parameters=given_values(arguments) | arguments.absolute,
                threads=threads,
                outputs=tuple(outputs.get(task.file, ())),
            )
            for task in given
        ]
        if not getattr(arguments, "bop", False):
            return run_tasks(tasks, arguments, _text)[0]
        for name in ("json", "table", "resume", "shard"):
            if getattr(arguments, name):
                raise InvalidParameter(f"{name} is given beside bop; allowed is one of them")
        return _print_models_info(tasks, arguments)


def _output_suffix(format_name: str) -> str:
    if f".{format_name}" not in ANALYSIS_FORMATS:
        allowed = ", ".join(name[1:] for name in ANALYSIS_FORMATS)
        raise InvalidParameter(f"format is {format_name}; allowed are {allowed}")
    return f".{format_name}"


def _print_models_info(tasks: Sequence[FileTask], arguments: argparse.Namespace) -> int:
    entries = {}
    status = 0
    for record in worked_on(tasks, arguments):
        status = max(status, tell(record))
        if "bop" in record:
            entries[record["file"]] = record["bop"]
    print(json.dumps(entries, indent=1))
    return status


def _text(record: Record) -> str:
    lines = [record["file"]]
    if "group" in record:
        lines += [
            f"  group     {record['group']}, score {record['score']:.3f}",
            f"  centre    {shown(record['centre'])}",
        ]
    lines += [
        f"  plane     normal {shown(plane['normal'])}, offset {plane['offset']:g}"
        for plane in record["planes"]
    ]
    lines += [
        f"  axis      {_order(axis['order'])}, direction {shown(axis['direction'])}"
        for axis in record["axes"]
    ]
    if "group" in record:
        lines += ["  inversion"] * record["inversion"]
    else:
        lines += [_transformation_text(each) for each in record["transformations"]]
        lines += [
            f"  {name.replace('_', ' '):<9} {shown(value)}"
            for name, value in record["statistics"].items()
        ]
    lines.append(f"  time      {1000 * record['seconds']:.1f} ms")
    return "\n".join(lines)


def _transformation_text(each: dict[str, Any]) -> str:
    points = f"{len(each['from'])} points" if each["from"] else "all points"
    return f"  {each['kind']:<9} {points}, score {each['score']:.3f}"


def _order(order: int | str) -> str:
    return order if isinstance(order, str) else f"order {order}"
