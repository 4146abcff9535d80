"""symsurf symmetries: the point groups of files."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from .._core import InvalidParameter
from ..point_group import Symmetries, symmetries
from .batch_options import add_files
from .each_file import for_each_file
from .values import shown, whole

SUMMARY = "Find all symmetries of each file: mirror planes, rotation axes and their group"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_files(parser)
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print a JSON object a file, on a line")
    form.add_argument(
        "--bop",
        action="store_true",
        help="print one JSON object: for each file an entry of the BOP toolkit's models_info, with "
        "symmetries_discrete and symmetries_continuous",
    )
    parser.add_argument(
        "--minimum-score",
        default="0.7",
        metavar="VALUE",
        help="of each element, [0, 1], default %(default)s",
    )
    parser.add_argument("--threads", default="0", metavar="N", help="0: all there are")


def run(arguments: argparse.Namespace) -> int:
    entries: dict[str, dict[str, Any]] = {}
    minimum_score = _score(arguments.minimum_score)

    def do(path: Path) -> None:
        found = symmetries(path, minimum_score=minimum_score, threads=whole(arguments.threads))
        if arguments.bop:
            entries[str(path)] = found.to_bop()
        elif arguments.json:
            print(json.dumps({"file": str(path)} | found.to_json()), flush=True)
        else:
            print(_text(path, found), flush=True)

    status = for_each_file(arguments.files, do)
    if arguments.bop:
        print(json.dumps(entries, indent=1))
    return status


def _score(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InvalidParameter(f"minimum_score is {text}; allowed is [0, 1]") from None


def _text(path: Path, found: Symmetries) -> str:
    lines = [
        str(path),
        f"  group     {found.group}, score {found.score:.3f}",
        f"  centre    {shown(found.centre)}",
    ]
    lines += [
        f"  plane     normal {shown(plane.normal)}, offset {plane.offset:g}"
        for plane in found.planes
    ]
    lines += [
        f"  axis      {'continuous' if axis.continuous else f'order {axis.order}'}, "
        f"direction {shown(axis.direction)}"
        for axis in found.axes
    ]
    if found.inversion:
        lines.append("  inversion")
    lines.append(f"  time      {1000 * found.seconds:.1f} ms")
    return "\n".join(lines)
