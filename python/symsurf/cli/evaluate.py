"""symsurf evaluate: a result against the truth of its sample."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from .. import metrics
from .._core import InvalidInput, Sphere, SurfaceMirror
from ..plain import plain
from ..reading import read
from ..saved_text import read_text
from ..truth import read_truth, truth_path
from .each_file import for_each_file

SUMMARY = "Compare results (TXT) with the truth of the sample they were found in"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT", help="a result's TXT")
    parser.add_argument(
        "--sample",
        type=Path,
        required=True,
        metavar="FILE",
        help="the points; their truth lies beside them",
    )
    parser.add_argument("--json", action="store_true", help="print a JSON object a result")


def run(arguments: argparse.Namespace) -> int:
    def do(path: Path) -> None:
        figures = evaluated(path, arguments.sample)
        if arguments.json:
            print(json.dumps({"file": str(path)} | plain(figures)))
        else:
            print(path)
            print("\n".join(f"  {name:16} {value:.6g}" for name, value in figures.items()))

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
