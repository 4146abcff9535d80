"""symsurf generate: points with a known mirror."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import _core
from .._core import Generator
from ..reading import read
from ..saving.points_format import require_points_suffix
from ..saving.truth import Truth, write_sample
from ..synthetic import Sample
from . import generate_benchmark
from .described_options import add_kinds, given_values
from .output_paths import add_output
from .terminal import say

SUMMARY = "Makes points with a known mirror, and a file with the truth beside them."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    commands = add_kinds(parser, _core.generators(), _add_files)
    summary = generate_benchmark.SUMMARY
    sub = commands.add_parser("benchmark", help=summary, description=summary, allow_abbrev=False)
    generate_benchmark.add_arguments(sub)
    sub.set_defaults(kind=None)


def _add_files(parser: argparse.ArgumentParser, kind: Generator) -> None:
    if kind.mirrors_points:
        parser.add_argument("--points", type=Path, metavar="FILE", help="the cloud to mirror")
    add_output(parser, type=Path, required=True, metavar="FILE", help="XYZ, CSV, TXT")


def run(arguments: argparse.Namespace) -> int:
    if arguments.kind is None:
        return generate_benchmark.run(arguments)
    require_points_suffix(arguments.output)
    given = getattr(arguments, "points", None)
    points = None if given is None else read(given).points
    sample = Sample(*_core.generate(arguments.kind.name, given_values(arguments), points))
    write_sample(arguments.output, sample.points, Truth(sample.truth, sample.pairs))
    skipped = f", {sample.skipped} skipped" if sample.skipped else ""
    say(f"{arguments.output}: {len(sample.points)} points{skipped}")
    return 0
