"""symsurf detect: the mirrors of files."""

from __future__ import annotations

import argparse
import math
from typing import Any

from .._core import InvalidParameter
from ..base.options import Search
from ..base.plain import shown
from ..batching.file_task import LARGE, MATCHES_SUFFIX, SUMMARY_SUFFIX, Record
from ..saving import FORMATS
from .batch_options import (
    add_batch_options,
    add_files,
    input_tasks,
    run_tasks,
    title_of,
    with_outputs,
)
from .method_options import add_method_options, given_parameters
from .output_paths import add_output
from .repeat_options import DEVIATIONS, add_repeat, given_repeat, tell_repeatability
from .shared_options import add_options
from .terminal import Parser
from .values import duration

SUMMARY = "Finds the mirror of each file."

_FORMATS = [SUMMARY_SUFFIX, MATCHES_SUFFIX, *FORMATS]


def add_arguments(parser: Parser) -> None:
    add_files(parser)
    group = parser.add_argument_group("output")
    add_output(
        group,
        metavar="PATH",
        help="with one file: write the result to this file, in the format of its suffix, such as "
        "mirror.stl; otherwise to this folder, under the name of each file and the suffixes of --formats",
    )
    group.add_argument(
        "--formats",
        metavar="LIST",
        help=f"in a folder, separated by commas: {SUMMARY_SUFFIX[1:]}, a small file with the mirror; with "
        "the pairs of all points json, vtp, ply, txt; the mirror alone as stl, obj, off, glb; "
        f"{MATCHES_SUFFIX[1:]}, how the mirror fits each point; default {SUMMARY_SUFFIX[1:]}",
    )
    add_batch_options(parser, group)
    group = parser.add_argument_group("search")
    add_options(group, Search)
    group.add_argument(
        "--in-chunks",
        action="store_const",
        const=True,
        help=f"read LAS, LAZ, E57, NPY, PLY, PVTP and VTKHDF in chunks and downsample them; default for "
        f"files of more than {LARGE / 1e6:.0f} million points",
    )
    group.add_argument(
        "--use-normals",
        action="store_true",
        help="pass the normals in the files to the method; their sign is ignored; a file without normals is "
        "an error",
    )
    group.add_argument(
        "--ignore-faces", action="store_true", help="search with the points of a mesh alone"
    )
    group.add_argument(
        "--downsample",
        metavar="DIVISOR",
        help="downsample to about one point in DIVISOR, the means of the cells of a uniform grid; pairs "
        "are then pairs of these",
    )
    add_repeat(group)
    add_method_options(parser)


def run(arguments: argparse.Namespace) -> int:
    suffixes = _suffixes(arguments.formats or SUMMARY_SUFFIX)
    divisor = arguments.downsample
    if arguments.use_normals and divisor is not None:
        raise InvalidParameter("use_normals is given beside downsample; allowed is one of them")
    tasks = input_tasks(
        arguments,
        given_parameters(arguments) | given_repeat(arguments),
        use_faces=not arguments.ignore_faces,
        use_normals=arguments.use_normals,
        in_chunks=arguments.in_chunks,
        downsample=None if divisor is None else _divisor(divisor),
    )
    tasks = with_outputs(tasks, arguments, lambda _: suffixes, arguments.formats, _FORMATS)
    measured: list[Record] = []
    status = run_tasks(tasks, arguments, _text, measured.append)[0]
    tell_repeatability(arguments, measured)
    return status


def _divisor(text: str) -> float:
    try:
        divisor = float(text)
    except ValueError:
        divisor = math.nan
    if not 1 <= divisor < math.inf:
        raise InvalidParameter(f"downsample is {text}; allowed is [1, inf)")
    return divisor


def _suffixes(formats: str) -> list[str]:
    suffixes = [f".{name.strip().lstrip('.')}" for name in formats.split(",")]
    if any(suffix not in _FORMATS for suffix in suffixes):
        names = ", ".join(name[1:] for name in _FORMATS)
        raise InvalidParameter(f"formats is {formats}; allowed are {names}")
    return suffixes


def _text(record: Record) -> str:
    lines = [title_of(record)]
    if record["mirror"] is not None:
        lines.append(f"  mirror    {_mirror(record['mirror'])}")
    lines.append(f"  verdict   {record['verdict']}: {record['reason']}")
    lines.append(f"  score     {record['score']:.3f} (method {record['method']})")
    if record["parameters"].get("pairs", True):
        paired = f"{record['pairs']} of {record['points']} points"
        if record["pairs"]:
            paired += f", median residual {record['median_residual']:.3g}"
        lines.append(f"  pairs     {paired}")
    if others := record["candidates"]:
        scores = " ".join(shown(other["score"], ".3f") for other in others)
        lines.append(f"  others    {len(others)} with scores {scores}")
    repeated = [(name, record["statistics"].get(name)) for name in DEVIATIONS]
    figures = ", ".join(f"{name} {shown(value)}" for name, value in repeated if value is not None)
    lines += [f"  repeats   {figures}"] if figures else []
    lines.append(f"  time      {duration(record['seconds'])}")
    return "\n".join(lines)


def _mirror(mirror: dict[str, Any]) -> str:
    numbers = (f"{name} {shown(value)}" for name, value in mirror.items() if name != "kind")
    return ", ".join([mirror["kind"], *numbers])
