"""symsurf demo: mirrors of real meshes, whole and damaged, against the truth."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..demonstration import Finding, cases, find
from . import demo_thesis

SUMMARY = "Find the mirrors of two real meshes, whole and damaged; print a table, draw pictures"

HEADINGS = "mesh", "damage", "points", "angle error", "offset error", "score", "time"
ROW = "{:9} {:18} {:>7} {:>12} {:>13} {:>7} {:>9}"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "which",
        nargs="?",
        choices=("shapes", "thesis"),
        default="shapes",
        help="real meshes, or the thesis's tables beside its numbers; default %(default)s",
    )
    parser.add_argument("--no-pictures", action="store_true", help="print the table only")
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("symsurf-demo"),
        metavar="DIR",
        help="where the pictures go; default %(default)s",
    )


def run(arguments: argparse.Namespace) -> int:
    if arguments.which == "thesis":
        return demo_thesis.run(arguments)
    arguments.output.mkdir(parents=True, exist_ok=True)
    print(ROW.format(*HEADINGS))
    findings = []
    for case in cases():
        finding = find(case)
        findings.append(finding)
        print(_row(finding), flush=True)
    if arguments.no_pictures:
        return 0
    from .. import gallery

    for path in gallery.draw(findings, arguments.output):
        print(path)
    return 0


def _row(finding: Finding) -> str:
    result = finding.result
    return ROW.format(
        finding.case.name,
        finding.case.damage,
        len(finding.case.shape.points),
        f"{finding.angle:.4f}°",
        f"{finding.offset:.4f} %",
        f"{result.score:.3f}",
        f"{1000 * result.seconds:.1f} ms",
    )
