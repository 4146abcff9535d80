"""symsurf symmetries, ...: a command for each analysis, made from its description."""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .._core import Analysis, InvalidParameter
from ..base.options import Search
from ..base.plain import shown
from ..batching.file_task import FileTask, Record
from ..results import Symmetries
from ..results.analysis_results import RESULTS
from ..saving.shape_files import formats_of
from .batch_options import (
    add_batch_options,
    add_files,
    add_other,
    input_tasks,
    run_tasks,
    tell,
    title_of,
    with_outputs,
    worked_on,
)
from .described_options import add_parameters, given_values
from .output_paths import add_output
from .shared_options import add_options
from .terminal import say
from .values import duration

# What pose estimators read, by the record's name for it.
_TABLES = {
    "bop": "an entry of the BOP toolkit's models_info, with symmetries_discrete and "
    "symmetries_continuous; those named obj_000001 are called by their number",
    "isaac": "the parameter symmetry_axes of Isaac ROS FoundationPose",
}


class AnalysisCommand:
    """What symsurf.cli takes for a command."""

    def __init__(self, analysis: Analysis) -> None:
        self._analysis = analysis
        self.SUMMARY = analysis.summary
        self._formats = formats_of(RESULTS[analysis.name])
        self._tables = _TABLES if analysis.name == Symmetries.analysis else {}

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        add_files(parser)
        if self._analysis.takes_other:
            add_other(parser, "onto which the first is laid", required=True)
        group = parser.add_argument_group("output")
        add_output(
            group,
            metavar="PATH",
            help="with one file: write the result to this file, in the format of its suffix; otherwise "
            "to this folder, one file per input",
        )
        group.add_argument(
            "--format",
            metavar="WORD",
            help=f"in a folder: {' or '.join(name[1:] for name in self._formats)}; json holds the whole "
            "result, ply, vtp and glb the shape with the arrays of the analysis; default json",
        )
        for name, content in self._tables.items():
            group.add_argument(
                f"--{name}",
                dest="pose_table",
                action="store_const",
                const=name,
                help=f"print one JSON object: for each file {content}",
            )
        add_batch_options(parser, group)
        add_options(parser.add_argument_group("search"), Search, ["nonfinite"])
        add_parameters(parser, self._analysis)

    def run(self, arguments: argparse.Namespace) -> int:
        suffix = self._suffix(arguments.format or "json")
        tasks = input_tasks(arguments, given_values(arguments), operation=self._analysis.name)
        tasks = with_outputs(tasks, arguments, lambda _: [suffix], arguments.format, self._formats)
        pose_table = getattr(arguments, "pose_table", None)
        if pose_table is None:
            return run_tasks(tasks, arguments, _text)[0]
        for name in ("json", "table", "resume", "shard"):
            if getattr(arguments, name):
                raise InvalidParameter(
                    f"{name} is given beside {pose_table}; allowed is one of them"
                )
        return _print_pose_table(pose_table, tasks, arguments)

    def _suffix(self, format_name: str) -> str:
        if f".{format_name}" not in self._formats:
            allowed = ", ".join(name[1:] for name in self._formats)
            raise InvalidParameter(f"format is {format_name}; allowed are {allowed}")
        return f".{format_name}"


def _print_pose_table(name: str, tasks: Sequence[FileTask], arguments: argparse.Namespace) -> int:
    entries = {}
    status = 0
    for record in worked_on(tasks, arguments):
        status = max(status, tell(record))
        if name in record:
            key = _object_number(record["file"]) if name == "bop" else None
            entries[key or record["file"]] = record[name]
    say(json.dumps(entries, indent=1))
    return status


def _object_number(file: str) -> str | None:
    """The toolkit's name of obj_000012.ply: "12"."""
    number = re.fullmatch(r"obj_(\d+)", Path(file).stem)
    return str(int(number[1])) if number else None


def _text(record: Record) -> str:
    lines = [title_of(record)]
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
    lines.append(f"  time      {duration(record['seconds'])}")
    return "\n".join(lines)


def _transformation_text(each: dict[str, Any]) -> str:
    points = f"{len(each['from'])} points" if each["from"] else "all points"
    return f"  {each['kind']:<9} {points}, score {each['score']:.3f}"


def _order(order: int | str) -> str:
    return order if isinstance(order, str) else f"order {order}"
