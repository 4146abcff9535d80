"""symsurf demo: mirrors of real meshes, as they are and changed, against the truth, and what is done
with them."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._core import InvalidParameter
from ..batching import processors, threads_of_each
from ..batching.file_task import FileTask
from ..batching.report_files import report_tasks, write_report
from ..batching.result_table import row_of
from ..batching.running import records
from ..demonstration import Deed, Finding, cases, deeds, draw, file_name, find
from ..report import require_viewer
from ..saving import write_whole
from ..saving.ply_format import shape_ply_bytes
from . import demo_thesis
from .output_paths import add_output
from .progress_bar import ProgressBar
from .terminal import say
from .values import duration

SUMMARY = "Finds the mirrors of two real meshes, straight, bent and damaged, and uses them; with a report."

HEADINGS = "mesh", "change", "points", "mirror", "score", "error", "time"
ROW = "{:9} {:16} {:>7} {:>9} {:>7} {:>10} {:>9}"
DEED_HEADINGS = "mesh", "operation", "what", "is", "should be"
DEED_ROW = "{:9} {:11} {:38} {:>9} {:>9}"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "which",
        nargs="?",
        choices=("shapes", "thesis"),
        default="shapes",
        help="real meshes, or the thesis's tables beside its numbers; default %(default)s",
    )
    parser.add_argument(
        "--tables",
        nargs="+",
        metavar="NUMBER",
        help="of the thesis these alone, such as 5.1; default all",
    )
    parser.add_argument(
        "--no-pictures", action="store_true", help="print the tables only, without a report"
    )
    add_output(
        parser,
        type=Path,
        default=Path("symsurf-demo"),
        metavar="DIR",
        help="where meshes, pictures and report go; default %(default)s",
    )


def run(arguments: argparse.Namespace) -> int:
    if arguments.which == "thesis":
        return demo_thesis.run(arguments)
    if arguments.tables:
        raise InvalidParameter("tables is given for shapes; allowed is with thesis")
    if not arguments.no_pictures:
        require_viewer()
        arguments.output.mkdir(parents=True, exist_ok=True)
    say("Lengths are shares of the diagonal of the bounding box.\n")
    say(ROW.format(*HEADINGS))
    findings: list[Finding] = []
    done: list[Deed] = []
    for case in cases():
        with ProgressBar(f"{case.name} {case.change}") as bar:
            finding = find(case, bar)
            findings.append(finding)
            done += deeds(finding)
        say(_row(finding))
    say(f"\n{DEED_ROW.format(*DEED_HEADINGS)}")
    for deed in done:
        say(_deed_row(deed))
    if arguments.no_pictures:
        return 0
    _show(findings, done, arguments.output)
    return 0


def _show(findings: list[Finding], done: list[Deed], folder: Path) -> None:
    """Pictures, the meshes, and the report on them."""
    say("\npictures")
    for path in draw(findings, done, folder):
        say(f"  {path}")
    meshes = []
    for finding in findings:
        meshes.append(folder / f"{file_name(finding.case)}.ply")
        write_whole(meshes[-1], shape_ply_bytes(finding.case.shape, {}))
    jobs = processors()
    page = folder / "report.html"
    threads = threads_of_each(0, jobs)
    tasks = report_tasks([FileTask(mesh, threads=threads) for mesh in meshes], page)
    rows = []
    with ProgressBar("report") as bar:
        for record in records(tasks, jobs=jobs):
            rows.append(row_of(record))
            bar(len(rows) / len(tasks), even=True)
    write_report(page, tasks, rows)
    say(f"report\n  {page}")


def _row(finding: Finding) -> str:
    result = finding.result
    return ROW.format(
        finding.case.name,
        finding.case.change,
        len(finding.case.shape.points),
        result.mirror.kind if result.mirror is not None and result.verdict == "found" else "none",
        f"{result.score:.3f}",
        f"{finding.error:.4f} %",
        duration(result.seconds),
    )


def _deed_row(deed: Deed) -> str:
    return DEED_ROW.format(
        deed.case.name,
        deed.result.operation,
        deed.figure,
        f"{deed.value:.3f} %",
        f"{deed.truth:g} %",
    )
