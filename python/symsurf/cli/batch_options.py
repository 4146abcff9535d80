"""What the commands for many files share: their options, and how they go through the files."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from .._core import InvalidParameter, require_found_parameter
from ..base.options import Reading, Search
from ..base.printable import printable
from ..batching import require_jobs, threads_of_each
from ..batching.file_task import PICTURE_SUFFIX, FileTask, Record, of_parts, perform
from ..batching.growing_table import GrowingTable
from ..batching.result_table import row_of
from ..batching.running import Ended, ended, in_order
from ..batching.shards import positions, shard_from
from ..plotting.drawing import import_pyvista
from ..reading import files_in, known_names, require_format
from ..saving.output_files import output_files, require_apart
from ..saving.sole_writer import sole_writer
from . import output_paths
from .progress_bar import ProgressBar
from .shared_options import Group, add_options, given_options
from .terminal import complain, say, standard_input
from .values import whole

STANDARD_INPUT = Path("-")


def add_files(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("input")
    group.add_argument(
        "files",
        nargs="+",
        type=Path,
        metavar="FILE",
        help=f"{known_names()}; a folder: the files in it that can be read; -: standard input",
    )
    group.add_argument(
        "--input-format",
        metavar="WORD",
        help="read the files as this format, such as ply or ply.gz; standard input needs it",
    )
    add_options(group, Reading)
    group.add_argument(
        "--parts",
        metavar="WORD",
        help="one result per part of each file: connected, or the name of a point array with labels",
    )
    group.add_argument(
        "--absolute",
        action="store_const",
        const={"absolute": True},
        default={},
        help="lengths among the parameters are in input units, not fractions of the diagonal",
    )


def add_other(parser: argparse.ArgumentParser, use: str, required: bool = False) -> None:
    parser.add_argument(
        "--other",
        type=Path,
        metavar="PATH",
        required=required,
        help=f"second of two shapes of a pair, {use}: a file, or a folder with a file of the same name",
    )


def input_tasks(
    arguments: argparse.Namespace, parameters: Mapping[str, Any], **fields: Any
) -> list[FileTask]:
    """A task for each file on the command line, with these fields."""
    suffix = arguments.input_format and require_format(arguments.input_format)
    input_format = arguments.input_format = suffix and suffix[1:]
    asked = FileTask(
        Path(),
        input_format=input_format,
        parameters=parameters | arguments.absolute,
        threads=threads_of_each(whole(arguments.threads), _jobs(arguments)),
        unit=arguments.unit,
        other=getattr(arguments, "other", None),
        **given_options(arguments) | fields,
    )
    tasks = []
    for path in files_in(arguments.files):
        if path != STANDARD_INPUT:
            tasks.append(replace(asked, file=path, other=_beside(asked.other, path)))
        elif input_format is None:
            raise InvalidParameter("- is standard input, which needs --input-format, such as ply")
        else:
            content = standard_input()
            tasks.append(replace(asked, file=Path(f"stdin.{input_format}"), content=content))
    if arguments.parts is None:
        return tasks
    if getattr(arguments, "output", None) is not None:
        raise InvalidParameter("output is given beside parts; allowed is one of them")
    return [each for task in tasks for each in of_parts(task, arguments.parts)]


def title_of(record: Record) -> str:
    """The file, and the part of it that was worked on."""
    part = f", part {record['part']}" if "part" in record else ""
    return printable(record["file"]) + part


def _beside(other: Path | None, path: Path) -> Path | None:
    return other / path.name if other is not None and other.is_dir() else other


def add_batch_options(parser: argparse.ArgumentParser, output: Group) -> None:
    """Those of many files, and the picture among those of the output."""
    group = parser.add_argument_group("many files")
    output.add_argument(
        "--plot", action="store_true", help="draw a PNG per file beside that of --output"
    )
    group.add_argument(
        "--shard",
        metavar="I/N",
        help="process every N-th file, from the I-th on (I from 1 to N): for a job array in which all jobs "
        "get the same files; `symsurf table merge` merges their tables",
    )
    add_table_options(group)


def add_table_options(parser: Group) -> None:
    parser.add_argument(
        "--table",
        type=Path,
        metavar="FILE",
        help="write a CSV with one row per file, also for failed files",
    )
    parser.add_argument(
        "--resume",
        action="store_true",
        help="keep the rows of the table and process the other files and those that failed; without a "
        "table start one",
    )
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object per file, each on a line"
    )
    parser.add_argument(
        "--jobs",
        default="1",
        metavar="N",
        help="number of files processed at once; default %(default)s",
    )
    parser.add_argument(
        "--threads",
        default="0",
        metavar="N",
        help="number of threads per job; 0: all, divided among the jobs",
    )
    parser.add_argument(
        "--unit", default="", metavar="WORD", help="unit of the coordinates, such as mm: a label"
    )


def add_mirror_options(parser: argparse.ArgumentParser) -> Group:
    """How the mirror of an operation is found; gives what more can be added to."""
    group = parser.add_argument_group("mirror")
    add_options(group, Search)
    group.add_argument("--require-found", action="store_true", help=require_found_parameter().doc)
    return group


def _jobs(arguments: argparse.Namespace) -> int:
    jobs = whole(arguments.jobs)
    require_jobs(jobs)
    return jobs


def with_outputs(
    tasks: list[FileTask],
    arguments: argparse.Namespace,
    suffixes_of: Callable[[Path], Sequence[str]],
    formats: str | None,
    allowed: Sequence[str],
) -> list[FileTask]:
    """The tasks with the files to write for each file to read, a picture last.

    Args:
        suffixes_of: those of the files in a folder.
        formats: what was asked for by name; the suffix of an output that is a file is its format.
        allowed: the suffixes of such a file.
    """
    if arguments.output is None:
        if arguments.plot:
            raise InvalidParameter("plot is given without output; allowed is with one")
        return tasks
    if arguments.plot:
        import_pyvista()  # missing, it is missed before the work is done
    picture = [PICTURE_SUFFIX] if arguments.plot else []
    output = Path(arguments.output)
    if len(tasks) == 1 and output_paths.names_file(arguments.output):
        allowed = list(dict.fromkeys([*allowed, PICTURE_SUFFIX]))
        if formats is not None:
            raise InvalidParameter(
                f"output is {str(output)!r}, a file, whose suffix says the format, and {formats} is asked "
                "for, too; allowed is one of them"
            )
        if not output.name.lower().endswith(tuple(allowed)):
            raise InvalidParameter(
                f"output is {str(output)!r}; allowed are a folder and files that end in "
                f"{', '.join(allowed)}"
            )
        files = [output, *(output.with_suffix(suffix) for suffix in picture)]
        outputs = {tasks[0].file: list(dict.fromkeys(files))}
        require_apart(outputs)
    else:
        files = [task.file for task in tasks]
        outputs = output_files(files, output, lambda path: [*suffixes_of(path), *picture])
    return [replace(task, outputs=tuple(outputs[task.file])) for task in tasks]


def run_tasks(
    tasks: Sequence[FileTask],
    arguments: argparse.Namespace,
    text_of: Callable[[Record], str],
    hear: Callable[[Record], object] | None = None,
) -> tuple[int, list[dict[str, Any]]]:
    """Does the tasks, prints each record and passes it to ``hear``. Gives the exit status, 1 where any failed, and the
    rows of the table."""
    if arguments.table is not None:
        _require_table(arguments.table, tasks)
    tasks, places = _share_of(tasks, arguments)
    with _begun_table(tasks, places, arguments) as table:
        rows = {} if table is None else table.rows
        left = [index for index in range(len(tasks)) if index not in rows]

        def keep(number: int, record: Record) -> None:
            index = left[number]
            rows[index] = row_of(record)
            if table is not None:
                table.add(index, rows[index])

        status = 0
        for record in worked_on([tasks[index] for index in left], arguments, keep):
            status = max(status, tell(record))
            if hear is not None:
                hear(record)
            if "error" not in record:
                say(json.dumps(record) if arguments.json else _said(record, text_of))
    return status, [rows[index] for index in range(len(tasks))]


def _said(record: Record, text_of: Callable[[Record], str]) -> str:
    return "\n".join([text_of(record), *(f"  written   {file}" for file in record["written"])])


def _share_of(
    tasks: Sequence[FileTask], arguments: argparse.Namespace
) -> tuple[Sequence[FileTask], list[str]]:
    """The tasks of the shard, and where they stand among all; without a shard all tasks."""
    text = getattr(arguments, "shard", None)  # reports have none
    if text is None:
        return tasks, []
    shard = shard_from(text)
    its = [tasks[index] for index in shard.indices(len(tasks))]
    return its, positions(shard, len(tasks))


@contextmanager
def _begun_table(
    tasks: Sequence[FileTask], places: Sequence[str], arguments: argparse.Namespace
) -> Iterator[GrowingTable | None]:
    """It is finished where all went well."""
    path: Path | None = arguments.table
    if path is None:
        if arguments.resume:
            raise InvalidParameter(
                "resume is given without table; allowed is with the table to go on with"
            )
        yield None
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    with sole_writer(path):
        if not arguments.resume and path.exists() and path.stat().st_mtime > arguments.began:
            raise InvalidParameter(
                f"{path} was written by another run since this one began; allowed is another table, or "
                "--resume"
            )
        table = GrowingTable(path, tasks, places, arguments.resume)
        yield table
        table.finish()


def tell(record: Record) -> int:
    """Says on standard error what is to be said beside the result; 1 where the file failed."""
    for notice in record.get("notices", []):
        complain(f"{record['file']}: {notice}")
    if "error" in record:
        complain(record["error"])
    return 1 if "error" in record else 0


def worked_on(
    tasks: Sequence[FileTask],
    arguments: argparse.Namespace,
    keep: Callable[[int, Record], None] | None = None,
) -> Iterator[Record]:
    """The records in the order of the tasks, with a bar on a terminal. What is to be kept of each is
    kept as soon as it ends, with the index of its task."""
    jobs = _jobs(arguments)

    def kept(bar: ProgressBar) -> Iterator[Ended]:
        found = ended(tasks, jobs=jobs) if jobs > 1 else _one_by_one(tasks, bar)
        for done, (index, record) in enumerate(found, 1):
            if keep is not None:
                keep(index, record)
            if done < len(tasks):
                bar.title = _title(tasks, done)
                bar(done / len(tasks), even=True)
            yield index, record

    with ProgressBar(_title(tasks, 0)) as bar:
        for record in in_order(kept(bar)):
            bar.clear()
            yield record


def _one_by_one(tasks: Sequence[FileTask], bar: ProgressBar) -> Iterator[Ended]:
    for index, task in enumerate(tasks):
        yield index, perform(task, partial(_within, bar, index, len(tasks)))


def _within(bar: ProgressBar, done: int, files: int, fraction: float) -> None:
    bar((done + fraction) / files, even=done > 0)


def _title(tasks: Sequence[FileTask], done: int) -> str:
    return printable(tasks[0].file.name) if len(tasks) == 1 else f"{done} of {len(tasks)} files"


def _require_table(table: Path, tasks: Sequence[FileTask]) -> None:
    """Raises what would be wrong with the table before the work is done."""
    output_paths.require_suffix("table", table, ".csv")
    taken = {task.file.resolve() for task in tasks}
    taken |= {output.resolve() for task in tasks for output in task.outputs}
    output_paths.require_apart(table, taken)
