"""symsurf asymmetry, align, ...: a command for each operation, made from its description."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from .. import mirror_operations
from .._core import InvalidInput, InvalidParameter, Operation
from ..detection import detect
from ..mirror_operations import OperationResult
from ..result import Result
from ..saving import SHAPE_FORMATS
from ..saving.json_format import mirror_record, plain
from ..shape import read
from .described_options import add_parameters, given_values
from .each_file import for_each_file, output_files
from .values import shown, whole


class OperationCommand:
    """What symsurf.cli takes for a command."""

    def __init__(self, operation: Operation) -> None:
        self._operation = operation
        self.SUMMARY = operation.summary

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("files", nargs="+", type=Path, metavar="FILE", help="as for detect")
        parser.add_argument(
            "--output",
            type=Path,
            metavar="DIR",
            help="write each shape to DIR, with what the operation gives each point",
        )
        parser.add_argument(
            "--format",
            default="vtp",
            metavar="WORD",
            help=f"of --output: {', '.join(name[1:] for name in SHAPE_FORMATS)}; default %(default)s",
        )
        parser.add_argument("--json", action="store_true", help="print a JSON object a file")
        parser.add_argument(
            "--method", default="auto", metavar="M", help="what finds the mirror; default auto"
        )
        parser.add_argument("--threads", default="0", metavar="N", help="0: all there are")
        add_parameters(parser, self._operation)

    def run(self, arguments: argparse.Namespace) -> int:
        outputs = _outputs(arguments)

        def do(path: Path) -> None:
            found, result = self._result(path, arguments)
            for output in outputs.get(path, []):
                output.parent.mkdir(parents=True, exist_ok=True)
                result.save(output)
            if arguments.json:
                print(json.dumps(_record(path, found, result)))
            else:
                print(_report(path, found, result))

        return for_each_file(arguments.files, do)

    def _result(self, path: Path, arguments: argparse.Namespace) -> tuple[Result, OperationResult]:
        shape = read(path)
        threads = whole(arguments.threads)
        found = detect(shape, arguments.method, threads=threads)
        if found.verdict != "found":
            raise InvalidInput(f"the shape has no mirror: {found.reason}")
        operate = getattr(mirror_operations, self._operation.name)
        return found, operate(shape, found, threads=threads, **given_values(arguments))


def _outputs(arguments: argparse.Namespace) -> dict[Path, list[Path]]:
    """The file to write for each file to read."""
    if arguments.output is None:
        return {}
    suffix = f".{arguments.format}"
    if suffix not in SHAPE_FORMATS:
        allowed = ", ".join(name[1:] for name in SHAPE_FORMATS)
        raise InvalidParameter(f"format is {arguments.format}; allowed are {allowed}")
    return output_files(arguments.files, arguments.output, [suffix])


def _record(path: Path, found: Result, result: OperationResult) -> dict[str, Any]:
    return {
        "file": str(path),
        "points": len(result.shape.points),
        "mirror": mirror_record(found.mirror),
        "score": plain(found.score),
        "parameters": plain(result.parameters),
        "statistics": plain(result.statistics),
    }


def _report(path: Path, found: Result, result: OperationResult) -> str:
    kind = found.mirror.kind if found.mirror is not None else "none"
    lines = [str(path), f"  mirror              {kind}, score {found.score:.3f}"]
    for name, value in result.statistics.items():
        share = result.statistics.get(f"{name}_of_diagonal")
        if name.endswith("_of_diagonal"):
            continue
        if share is not None:
            lines.append(f"  {name:<19} {value:<12.6g} {100 * share:.4g} % of the diagonal")
        elif getattr(value, "ndim", 1) == 2:
            rows = ["  ".join(f"{number:12.6g}" for number in row) for row in value]
            lines += [f"  {name}", *(f"    {row}" for row in rows)]
        else:
            lines.append(f"  {name:<19} {shown(value)}")
    return "\n".join(lines)
