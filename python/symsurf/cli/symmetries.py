"""symsurf symmetries: the point groups of files."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace

from .._core import InvalidParameter
from ..file_task import SYMMETRIES, FileTask, Record
from .batch_options import (
    add_files,
    add_table_options,
    input_tasks,
    jobs_and_threads,
    run_tasks,
    tell,
    worked_on,
)
from .values import shown

SUMMARY = "Find all symmetries of each file: mirror planes, rotation axes and their group"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_files(parser)
    add_table_options(parser)
    parser.add_argument(
        "--bop",
        action="store_true",
        help="print one JSON object: for each file an entry of the BOP toolkit's models_info, with "
        "symmetries_discrete and symmetries_continuous",
    )
    parser.add_argument(
        "--minimum-score",
        default="0.7",
        metavar="VALUE",
        help="of the group, [0, 1], default %(default)s",
    )


def run(arguments: argparse.Namespace) -> int:
    _, threads = jobs_and_threads(arguments)
    parameters = {"minimum_score": _score(arguments.minimum_score)}
    tasks = [
        replace(task, operation=SYMMETRIES, parameters=parameters, threads=threads)
        for task in input_tasks(arguments)
    ]
    if not arguments.bop:
        return run_tasks(tasks, arguments, _text)[0]
    for name in ("json", "table"):
        if getattr(arguments, name):
            raise InvalidParameter(f"{name} is given beside bop; allowed is one of them")
    return _print_models_info(tasks, arguments)


def _score(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InvalidParameter(f"minimum_score is {text}; allowed is [0, 1]") from None


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
    lines = [
        record["file"],
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
    if record["inversion"]:
        lines.append("  inversion")
    lines.append(f"  time      {1000 * record['seconds']:.1f} ms")
    return "\n".join(lines)


def _order(order: int | str) -> str:
    return order if isinstance(order, str) else f"order {order}"
