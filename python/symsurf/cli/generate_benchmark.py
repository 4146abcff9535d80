"""symsurf generate benchmark: the benchmark of curved mirrors as files."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..benchmark import SIZES, benchmark
from ..benchmark.files import write_benchmark
from .output_paths import add_output
from .terminal import say
from .values import whole

SUMMARY = (
    "Makes the benchmark of curved mirrors: a folder of points, their true images and the truth."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    sizes = ", ".join(f"{name} ({count} points)" for name, count in SIZES.items())
    parser.add_argument("--size", default="medium", metavar="WORD", help=f"{sizes}; default medium")
    parser.add_argument("--seed", type=whole, default=0, metavar="NUMBER", help="default 0")
    parser.add_argument(
        "--cases",
        nargs="+",
        default=["*"],
        metavar="PATTERN",
        help="cases to make, such as 'head-*-noise-1'; default all",
    )
    add_output(parser, type=Path, required=True, metavar="DIR", help="a folder")


def run(arguments: argparse.Namespace) -> int:
    samples = benchmark(arguments.size, arguments.seed, arguments.cases)
    names = write_benchmark(arguments.output, samples, arguments.size, arguments.seed)
    say(f"{arguments.output}: {len(names)} cases of {SIZES[arguments.size]} points")
    return 0
