"""symsurf asymmetry, align, ...: a command for each operation, made from its description."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InvalidInput, Mirror, Operation
from ..base.options import Search, part
from ..batching.file_task import PAGE_SUFFIX, Record
from ..mirror_operations.functions import takes_pairs
from ..mirror_operations.operate import require_no_search
from ..reading.json_records import read_mirror
from ..results import plane_of
from ..results.operation_results import RESULTS, Asymmetry
from ..results.summary import figures, percent, value_text
from ..saving.same_format import REWRITERS
from ..saving.shape_files import SHAPES, formats_of, makes_shape, output_suffix
from .batch_options import (
    add_batch_options,
    add_files,
    add_mirror_options,
    add_other,
    input_tasks,
    run_tasks,
    title_of,
    with_outputs,
)
from .described_options import add_parameters, given_values
from .output_paths import add_output
from .repeat_options import add_repeat, given_repeat, tell_repeatability
from .shared_options import given_options
from .terminal import complain

FAILED_INSPECTION = 3
_SHOWN_PATCHES = 10
_KINDS = ("vector", "normal", "tensor")


class OperationCommand:
    """What symsurf.cli takes for a command."""

    def __init__(self, operation: Operation) -> None:
        self._operation = operation
        self.SUMMARY = operation.summary

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        add_files(parser)
        group = parser.add_argument_group("output")
        add_output(
            group,
            metavar="PATH",
            help="with one file: write the shape to this file, in the format of its suffix, such as x.stl; "
            "otherwise write the shapes to this folder; with the arrays of the operation if possible",
        )
        is_in_arrays = not makes_shape(self._operation)
        other = ", or PLY, since other formats hold no arrays" if is_in_arrays else ""
        group.add_argument(
            "--format",
            metavar="WORD",
            help=f"in a folder: input, the format of the file, of which all else is kept{other}; "
            f"or one of {', '.join(name[1:] for name in SHAPES)}: points and faces, the first three "
            "with arrays; default input",
        )
        add_batch_options(parser, group)
        add_mirror_options(parser).add_argument(
            "--mirror",
            metavar="MIRROR",
            help="use this mirror for all files instead of finding one: a plane such as x=0 or y=-1.5; or "
            'a file, JSON written by detect or {"mirror": {"kind": "sphere", "centre": [0, 0, 0], '
            '"radius": 1}}',
        )
        if self._operation.takes_other:
            add_other(parser, "in place of a mirror")
        add_parameters(parser, self._operation)
        if takes_pairs(self._operation):
            landmarks = parser.add_argument_group("landmarks, with --pairing homologous")
            landmarks.add_argument(
                "--pairs",
                type=Path,
                metavar="CSV",
                help="landmarks that mirror each other, a pair per row: two indices of points from 0, or the "
                "six coordinates of both",
            )
            landmarks.add_argument(
                "--pairs-sd",
                type=float,
                metavar="NUMBER",
                help="standard deviation of placing a landmark, in the unit of the file; default 0",
            )
        if self._operation.name == Asymmetry.operation:
            inspection = parser.add_argument_group("inspection, lengths in the unit of the file")
            inspection.add_argument(
                "--bands",
                type=_limits,
                metavar="X,Y",
                help="limits of the distance, such as 0.1,0.3: report the area within each and the "
                "connected patches above the smallest",
            )
            add_repeat(inspection)
            inspection.add_argument(
                "--fail-above",
                type=float,
                metavar="NUMBER",
                help=f"exit with status {FAILED_INSPECTION} if the distance of a point is above it",
            )
        arrays = parser.add_argument_group("arrays of the file")
        for kind in _KINDS:
            arrays.add_argument(
                f"--{kind}",
                action="append",
                default=[],
                metavar="NAME",
                help=f"the {kind}s NAME, such as the columns NAME_x, NAME_y and NAME_z, turn with the "
                "points; may be repeated"
                if kind != "tensor"
                else "the same of symmetric tensors: the columns NAME_0 to NAME_5, in the order xx yy zz "
                "xy yz xz, or NAME_0 to NAME_8",
            )

    def run(self, arguments: argparse.Namespace) -> int:
        name = self._operation.name
        mirror = arguments.mirror and _mirror(arguments.mirror)
        if mirror is not None:
            require_no_search(Search(**part(Search, given_options(arguments))))
        kinds = {name: kind for kind in _KINDS for name in getattr(arguments, kind)}
        tasks = input_tasks(
            arguments,
            given_values(arguments)
            | ({"kinds": kinds} if kinds else {})
            | ({"pairs": _landmarks(path)} if (path := getattr(arguments, "pairs", None)) else {})
            | {
                name: value
                for name in ("bands", "pairs_sd")
                if (value := getattr(arguments, name, None)) is not None
            }
            | given_repeat(arguments),
            operation=name,
            mirror=mirror,
            require_found=arguments.require_found,
        )
        own = {*(task.suffix for task in tasks)}.intersection(REWRITERS)
        pages = [PAGE_SUFFIX] if name == Asymmetry.operation else []
        tasks = with_outputs(
            tasks,
            arguments,
            lambda path: [
                output_suffix(path, name, arguments.format or "input", arguments.input_format)
            ],
            arguments.format,
            [*formats_of(RESULTS[name]), *own, *pages],
        )
        measured: list[Record] = []
        status, rows = run_tasks(tasks, arguments, _text, measured.append)
        tell_repeatability(arguments, measured)
        limit = getattr(arguments, "fail_above", None)
        if status or limit is None:
            return status
        above = [row for row in rows if float(row.get("max", 0)) > limit]
        for row in above:
            complain(
                f"{row['file']}: the largest distance is {float(row['max']):.6g}, above {limit:g}"
            )
        return FAILED_INSPECTION if above else 0


def _limits(text: str) -> list[float]:
    return [float(each) for each in text.split(",")]


def _landmarks(path: Path) -> list[Any]:
    """Pairs of indices, or of places."""
    try:
        rows = np.loadtxt(path, delimiter=",", ndmin=2)
    except ValueError as error:
        raise InvalidInput(f"{path}: {error}") from None
    if rows.shape[1] == 6:
        return list(rows.reshape(-1, 2, 3).tolist())
    if rows.shape[1] != 2 or np.any(rows != rows.round()):
        raise InvalidInput(
            f"{path}: rows have {rows.shape[1]} numbers; allowed are two whole numbers, the indices of "
            "points, or six, the coordinates of both"
        )
    return list(rows.astype(int).tolist())


def _mirror(given: str) -> Mirror:
    if "=" in given and not Path(given).exists():
        return plane_of(given, "--mirror")
    return read_mirror(Path(given))


def _text(record: Record) -> str:
    lines = [title_of(record)]
    if record["verdict"] is not None:
        lines += [
            f"  verdict             {record['verdict']}: {record['reason']}",
            f"  mirror              {record['mirror']['kind']}, score {record['score']:.3f}",
        ]
    elif record["mirror"] is not None:
        lines.append(f"  mirror              {record['mirror']['kind']}, given")
    for name, value, share in figures(record["statistics"]):
        text = value_text(name, value, share).replace("\n", "\n" + 22 * " ")
        lines.append(f"  {name.replace('_', ' '):<19} {text}")
    lines += [
        f"  within {band['limit']:<12g} {percent(band['share'])}"
        for band in record.get("bands", [])
    ]
    for number, patch in enumerate(record.get("patches", [])[:_SHOWN_PATCHES], 1):
        place = "  ".join(f"{x:.6g}" for x in patch["place"])
        lines.append(f"  patch {number:<13} {patch['largest']:.6g} at {place}")
    return "\n".join(lines)
