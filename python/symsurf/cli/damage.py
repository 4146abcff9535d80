"""symsurf damage: noise, holes, rotation, uneven density."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from .. import _core
from .._core import Damage
from ..reading import read
from ..saving.points_format import require_points_suffix
from ..saving.truth import read_truth, truth_path, write_sample
from ..synthetic import rotation_matrix
from .described_options import add_kinds, given_values
from .output_paths import add_output
from .terminal import say
from .values import whole

SUMMARY = "Damages points; the truth beside them, where there is one, follows."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_kinds(parser, _core.damages(), _add_files)


def _add_files(parser: argparse.ArgumentParser, kind: Damage) -> None:
    parser.add_argument("file", type=Path, metavar="FILE", help="the points")
    add_output(parser, type=Path, required=True, metavar="FILE", help="XYZ, CSV, TXT")
    parser.add_argument("--seed", default="0", metavar="N")


def run(arguments: argparse.Namespace) -> int:
    require_points_suffix(arguments.output)
    points = read(arguments.file).points
    values = given_values(arguments)
    damaged, kept = _core.damage(arguments.kind.name, points, values, whole(arguments.seed))
    truth = None
    if truth_path(arguments.file).exists():
        truth = read_truth(truth_path(arguments.file))
        truth = truth.kept(np.array(kept, dtype=np.int64), len(points))
        if arguments.kind.name == "rotation":
            angles = (values.get(name, 0.0) for name in ("roll", "pitch", "yaw"))
            truth = truth.moved(rotation_matrix(*angles))
    write_sample(arguments.output, damaged, truth)
    say(f"{arguments.output}: {len(damaged)} of {len(points)} points")
    return 0
