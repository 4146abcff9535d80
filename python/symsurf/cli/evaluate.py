"""symsurf evaluate: a result against the truth of its sample."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from .. import metrics
from .._core import InvalidInput, InvalidParameter, Sphere, SurfaceMirror
from ..base.plain import plain
from ..base.printable import printable
from ..reading import read
from ..reading.saved_text import read_text
from ..saving.truth import read_truth, truth_path
from . import evaluate_benchmark
from .each_file import for_each_file
from .terminal import say

SUMMARY = "Compares results with the truth of the sample, or the benchmark, they were found in."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "results",
        nargs="+",
        type=Path,
        metavar="RESULT",
        help="a result's TXT; with --benchmark a folder of them",
    )
    truth = parser.add_mutually_exclusive_group(required=True)
    truth.add_argument(
        "--sample", type=Path, metavar="FILE", help="the points; their truth lies beside them"
    )
    truth.add_argument(
        "--benchmark", type=Path, metavar="DIR", help="what generate benchmark has written"
    )
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object per result, or per case"
    )
    parser.add_argument(
        "--table",
        type=Path,
        metavar="FILE",
        help="with --benchmark: write a CSV with one row per case",
    )


def run(arguments: argparse.Namespace) -> int:
    if arguments.benchmark is not None:
        return evaluate_benchmark.run(
            arguments.results, arguments.benchmark, arguments.json, arguments.table
        )
    if arguments.table is not None:
        raise InvalidParameter(f"table is {str(arguments.table)!r}; it needs --benchmark")

    def do(path: Path) -> None:
        figures = evaluated(path, arguments.sample)
        if arguments.json:
            say(json.dumps({"file": str(path)} | plain(figures)))
        else:
            say(printable(str(path)))
            say("\n".join(f"  {name:16} {value:.6g}" for name, value in figures.items()))

    return for_each_file(arguments.results, do)


def evaluated(result: Path, sample: Path) -> dict[str, float]:
    """The errors by name: the thesis's, then those that need no frame."""
    found = read_text(result)
    truth = read_truth(truth_path(sample)).mirror
    points = read(sample).points
    if found.sphere is not None:
        if not isinstance(truth, Sphere):
            raise InvalidInput(f"{result} holds a sphere, the truth is a {truth.kind}")
        return metrics.sphere_errors(found.sphere, truth, points)._asdict()
    figures: dict[str, float] = {}
    if isinstance(truth, SurfaceMirror):
        errors = metrics.surface_errors(found.surface_points, truth)
        figures |= errors._asdict() | {"bias": errors.bias, "skipped": errors.skipped}
    return figures | {
        "distance": metrics.surface_distance(found.surface_points, truth, points),
        "coverage": metrics.coverage(found.surface_points, truth, points),
    }
