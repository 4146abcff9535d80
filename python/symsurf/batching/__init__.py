"""Many files, on this machine's processes or on any executor."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

from .. import _core
from .._core import InvalidParameter
from ..base.options import Reading, Search, documented, part
from ..reading import files_in
from ..saving.output_files import output_files
from ..saving.shape_files import output_suffix
from .file_task import DETECT, FileTask, of_parts
from .result_table import row_of
from .running import records

__all__ = ["batch"]


@documented
def batch(
    files: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    operation: str = DETECT,
    executor: Executor | None = None,
    *,
    jobs: int = 1,
    method: str = "auto",
    require_found: bool = False,
    threads: int = 0,
    output: str | os.PathLike[str] | None = None,
    unit: str = "",
    parts: str | None = None,
    seed: int = 0,
    nonfinite: str = "skip",
    threshold: float | None = None,
    label: int | str | None = None,
    scalars: str | None = None,
    external_files: bool = False,
    **parameters: object,
) -> Iterator[dict[str, Any]]:
    """Processes many files: finds the mirror of each and applies an operation.

    >>> pandas.DataFrame(symsurf.batch(files, "asymmetry", jobs=8))

    Args:
        files: names of files that ``read`` accepts, or a single one; a folder: all such files in
            it.
        operation: "detect", or the name of one of ``operations()``.
        executor: of ``concurrent.futures``, or one that is like those, such as Dask's
            ``Client.get_executor()``. Its workers must see the files under the same names.
        jobs: number of files processed at once, each in a process of its own that imports nothing
            of the caller's script; 1: in this process.
        {Search}
        require_found: a mirror with the verdict "none" is an error of its file; otherwise the
            operation uses it, and "verdict" of the row is "none".
        threads: number of threads per file; 0: all of the machine, divided among the jobs; 1 with
            an executor. The results do not depend on it.
        output: folder for the results: the shapes, in the format of each file, or in PLY if that
            format cannot hold the arrays of the operation; for "detect" a small JSON file per file.
        unit: of the coordinates, such as "mm": a label for the rows.
        parts: "connected", or the name of a point array with labels: one row per part of each file,
            with the number of the part in "part"; as for ``detect``. Not beside ``output``.
        {Reading}
        **parameters: parameters of the operation, for "detect" of the method.

    Returns:
        One row per file, in the order of the files, each as soon as it and those before it are done.
        A row is what ``symsurf OPERATION --table`` writes, by the name of the column. A file that
        fails, or whose worker dies, has the reason in "error", which is "" for the others. What an
        executor loses it is asked for once more, at the end; what a broken one leaves is done by a
        process for each file. Closing the iterator drops what was not begun. Nothing is kept of the
        rows: a script that may be ended writes each as it comes, or calls the command line, which has
        ``--resume``.

    Raises:
        InvalidParameter: an unknown operation, method or parameter, or a value out of its range;
            ``jobs`` beside an executor; two files of one name with an output folder.
    """
    options = part(Reading, locals()) | part(Search, locals())
    given = [files] if isinstance(files, (str, os.PathLike)) else files
    paths = files_in(Path(file) for file in given)
    require_operation(operation)
    if executor is not None and jobs != 1:
        raise InvalidParameter(
            f"jobs is {jobs} beside an executor, which has its own; leave it out"
        )
    require_jobs(jobs)
    outputs: dict[Path, list[Path]] = {}
    if output is not None:
        outputs = output_files(paths, Path(output), lambda path: [output_suffix(path, operation)])
    each = 1 if executor is not None and threads == 0 else threads_of_each(threads, jobs)
    tasks = [
        FileTask(
            path,
            operation,
            dict(parameters),
            require_found=require_found,
            threads=each,
            unit=unit,
            **options,
            outputs=tuple(outputs.get(path, ())),
        )
        for path in paths
    ]
    if parts is not None:
        if output is not None:
            raise InvalidParameter("output is given beside parts; allowed is one of them")
        tasks = [each for task in tasks for each in of_parts(task, parts)]
    return map(row_of, records(tasks, executor, jobs))


def require_operation(name: str) -> None:
    if name != DETECT and name not in _core.operations():
        allowed = ", ".join([DETECT, *_core.operations()])
        raise InvalidParameter(f"operation is {name!r}; allowed are {allowed}")


def require_jobs(jobs: Any) -> None:
    if not isinstance(jobs, int) or isinstance(jobs, bool) or jobs < 1:
        raise InvalidParameter(f"jobs is {jobs!r}; allowed is a whole number, [1, inf)")


def threads_of_each(threads: Any, jobs: int) -> Any:
    """So that all jobs together have no more threads than there are processors."""
    return max(1, processors() // jobs) if threads == 0 and jobs > 1 else threads


def processors() -> int:
    """Those that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
