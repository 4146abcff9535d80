"""symsurf detect: the mirrors of files."""

from __future__ import annotations

import argparse
import json
import math
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from .. import detection
from .._core import InvalidParameter
from ..inputs import InputWarning, finite_points, refuses
from ..result import Result
from ..sampling import downsample
from ..saving import FORMATS
from ..saving.json_format import plain, summary
from ..shape import read
from .each_file import for_each_file, output_files
from .method_options import add_method_options, given_parameters
from .progress_bar import ProgressBar
from .values import shown, whole

SUMMARY = "Find the mirror of each file"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "files", nargs="+", type=Path, metavar="FILE", help="PLY, OBJ, OFF, STL, XYZ, CSV or TXT"
    )
    parser.add_argument(
        "--output",
        type=Path,
        metavar="DIR",
        help="write each result to DIR, under the file's name and the suffixes of --formats",
    )
    parser.add_argument(
        "--formats",
        default="json,vtp,ply,txt",
        metavar="LIST",
        help="what --output writes, separated by commas; default %(default)s",
    )
    parser.add_argument("--json", action="store_true", help="print a JSON object a file, on a line")
    parser.add_argument("--threads", default="0", metavar="N", help="0: all there are")
    parser.add_argument("--seed", default="0", metavar="N", help="of the methods that draw lots")
    parser.add_argument(
        "--ignore-normals", action="store_true", help="do not use the normals in the files"
    )
    parser.add_argument(
        "--ignore-faces", action="store_true", help="let the points alone find the mirror of a mesh"
    )
    parser.add_argument(
        "--nonfinite",
        default="skip",
        metavar="WORD",
        help="what to do with points that are not finite: skip or refuse; default %(default)s",
    )
    parser.add_argument(
        "--downsample",
        metavar="DIVISOR",
        help="work on about one point in DIVISOR, the means of the cells of a uniform grid; pairs "
        "are then pairs of these",
    )
    add_method_options(parser)


def run(arguments: argparse.Namespace) -> int:
    outputs = _outputs(arguments)

    def do(path: Path) -> None:
        result = _detect(path, arguments)
        for output in outputs.get(path, []):
            output.parent.mkdir(parents=True, exist_ok=True)
            result.save(output)
        print(json.dumps(_record(path, result)) if arguments.json else _report(path, result))

    return for_each_file(arguments.files, do)


def _detect(path: Path, arguments: argparse.Namespace) -> Result:
    shape = read(path)
    points, faces = shape.points, shape.faces
    normals = None if arguments.ignore_normals else shape.normals
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        if arguments.downsample is not None:
            if not refuses(arguments.nonfinite):
                points = finite_points(points)
            points = downsample(points, math.ceil(len(points) / _divisor(arguments.downsample)))
            faces = normals = None
        with ProgressBar(path.name) as bar:
            result = detection.detect(
                points,
                arguments.method,
                faces=faces,
                use_faces=not arguments.ignore_faces,
                normals=normals,
                nonfinite=arguments.nonfinite,
                seed=whole(arguments.seed),
                threads=whole(arguments.threads),
                progress=bar,
                **given_parameters(arguments),
            )
    for warning in caught:
        print(f"symsurf: {path}: {warning.message}", file=sys.stderr)
    return result


def _divisor(text: str) -> float:
    try:
        divisor = float(text)
    except ValueError:
        divisor = math.nan
    if not 1 <= divisor < math.inf:
        raise InvalidParameter(f"downsample is {text}; allowed is [1, inf)")
    return divisor


def _outputs(arguments: argparse.Namespace) -> dict[Path, list[Path]]:
    """The files to write for each file to read."""
    if arguments.output is None:
        return {}
    suffixes = [f".{name.strip().lstrip('.')}" for name in arguments.formats.split(",")]
    for suffix in suffixes:
        if suffix not in FORMATS:
            allowed = ", ".join(name[1:] for name in FORMATS)
            raise InvalidParameter(f"formats is {arguments.formats}; allowed are {allowed}")
    return output_files(arguments.files, arguments.output, suffixes)


def _record(path: Path, result: Result) -> dict[str, Any]:
    return {
        "file": str(path),
        "points": _point_count(result),
        "pairs": len(result.pairs),
        "surface_points": len(result.surface_points),
        "median_residual": plain(_median_residual(result)),
        "verdict": result.verdict,
        "reason": result.reason,
    } | summary(result)


def _point_count(result: Result) -> int:
    return 0 if result.points is None else len(result.points)


def _median_residual(result: Result) -> float:
    return float(np.median(result.residuals)) if len(result.residuals) else float("nan")


def _report(path: Path, result: Result) -> str:
    lines = [str(path)]
    if result.mirror is not None:
        numbers = [f"{name} {shown(value)}" for name, value in result.mirror.numbers.items()]
        lines.append(f"  mirror    {', '.join([result.mirror.kind, *numbers])}")
    lines.append(f"  verdict   {result.verdict}: {result.reason}")
    lines.append(f"  score     {result.score:.3f} (method {result.method})")
    paired = f"{len(result.pairs)} of {_point_count(result)} points"
    residual = f"median residual {_median_residual(result):.3g}" if len(result.pairs) else ""
    lines.append(f"  pairs     {', '.join(filter(None, [paired, residual]))}")
    if result.candidates:
        scores = " ".join(f"{candidate.score:.3f}" for candidate in result.candidates)
        lines.append(f"  others    {len(result.candidates)} with scores {scores}")
    lines.append(f"  time      {1000 * result.seconds:.1f} ms")
    return "\n".join(lines)
