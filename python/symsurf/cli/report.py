"""symsurf report: pages about the asymmetry of files."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._core import InvalidParameter, operations
from ..file_task import FileTask, Record
from ..saving import write_whole
from ..saving.output_files import output_files
from .batch_options import add_files, add_table_options, jobs_and_threads, run_tasks
from .described_options import add_parameters, given_values

SUMMARY = "Write an HTML page with each shape, its mirror and its asymmetry, in 3D and in figures"
OPERATION = "asymmetry"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_files(parser)
    parser.add_argument(
        "--output",
        type=Path,
        required=True,
        metavar="FILE",
        help="the page, HTML, which needs nothing but itself; of several files the percentiles over "
        "all of them, with a page each in the folder FILE_files beside it",
    )
    add_table_options(parser)
    parser.add_argument(
        "--method", default="auto", metavar="M", help="what finds the mirror; default auto"
    )
    add_parameters(parser, operations()[OPERATION])


def run(arguments: argparse.Namespace) -> int:
    from ..report import cohort_page, require_viewer

    require_viewer()
    page: Path = arguments.output
    if page.suffix.lower() != ".html":
        raise InvalidParameter(f"output is {str(page)!r}; allowed is the suffix .html")
    files: list[Path] = arguments.files
    is_cohort = len(files) > 1
    folder = page.with_name(f"{page.stem}_files")
    pages = (
        {files[0]: [page]} if not is_cohort else output_files(files, folder, lambda _: [".html"])
    )
    _, threads = jobs_and_threads(arguments)
    tasks = [
        FileTask(
            path,
            OPERATION,
            arguments.method,
            given_values(arguments),
            threads=threads,
            unit=arguments.unit,
            outputs=tuple(pages[path]),
        )
        for path in files
    ]
    status, rows = run_tasks(tasks, arguments, _text)
    if is_cohort:
        links = {str(path): f"{folder.name}/{made[0].name}" for path, made in pages.items()}
        write_whole(page, cohort_page(page.stem, rows, links))
    if is_cohort or status == 0:
        print(page)
    return status


def _text(record: Record) -> str:
    rms = 100 * record["statistics"]["rms_of_diagonal"]
    kind = record["mirror"]["kind"]
    return (
        f"{record['file']}: {record['verdict']}, {kind}, score {record['score']:.3f}, asymmetry "
        f"{rms:.3g} % of the diagonal"
    )
