"""Which pages a report has, and what makes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from .._core import InvalidParameter
from ..report.files import files_page
from ..saving import write_whole
from ..saving.output_files import output_files
from .file_task import PAGE_SUFFIX, PICTURE_SUFFIX, FileTask

OPERATION = "asymmetry"


def report_tasks(given: Sequence[FileTask], page: Path) -> list[FileTask]:
    """The tasks, each writing the page of its file: of one file the page itself, of several one
    each in the folder PAGE_files, and a picture beside it."""
    if page.suffix.lower() != PAGE_SUFFIX:
        raise InvalidParameter(f"output is {str(page)!r}; allowed is the suffix {PAGE_SUFFIX}")
    files = [task.file for task in given]
    if page.resolve() in {file.resolve() for file in files}:
        raise InvalidParameter(f"{page} would overwrite an input; allowed is another name")
    pages = {files[0]: [page]}
    if len(files) > 1:
        pages = output_files(
            files, page.with_name(f"{page.stem}_files"), lambda _: [PAGE_SUFFIX, PICTURE_SUFFIX]
        )
    return [replace(task, operation=OPERATION, outputs=tuple(pages[task.file])) for task in given]


def write_report(page: Path, tasks: Sequence[FileTask], rows: Sequence[Mapping[str, Any]]) -> None:
    """Writes the page of all, where there are several; the others are there already.

    Args:
        tasks: those of ``report_tasks``.
        rows: of the table, one a task.
    """
    if len(tasks) > 1:
        links = {str(task.file): f"{page.stem}_files/{task.outputs[0].name}" for task in tasks}
        write_whole(page, files_page(f"{page.stem}: asymmetry of {len(tasks)} files", rows, links))
