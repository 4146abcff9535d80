"""Tasks done on this machine's processes or on any executor, whichever of these die."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from concurrent.futures import (
    BrokenExecutor,
    Executor,
    Future,
    ThreadPoolExecutor,
    as_completed,
)
from contextlib import closing
from functools import partial
from typing import TypeAlias

from .._core import InvalidParameter
from ..base.own_process import ProcessDied, Processes
from .file_task import FileTask, Record, failed, perform

Ended: TypeAlias = tuple[int, Record]
"""The index of a task, and its record."""


def records(
    tasks: Iterable[FileTask], executor: Executor | None = None, jobs: int = 1
) -> Iterator[Record]:
    """The record of each task, in their order."""
    return in_order(ended(tasks, executor, jobs))


def ended(
    tasks: Iterable[FileTask], executor: Executor | None = None, jobs: int = 1
) -> Iterator[Ended]:
    """The record of each task as it ends."""
    if executor is not None:
        return _by_executor(tasks, executor)
    return enumerate(map(perform, tasks)) if jobs == 1 else _by_processes(tasks, jobs)


def in_order(found: Iterable[Ended]) -> Iterator[Record]:
    """Each record as soon as those before it are there."""
    waiting: dict[int, Record] = {}
    following = 0
    for index, record in found:
        waiting[index] = record
        while following in waiting:
            yield waiting.pop(following)
            following += 1


def _by_executor(tasks: Iterable[FileTask], executor: Executor) -> Iterator[Ended]:
    """What is lost is asked for once more at the end, each alone: the worker may have died of another
    file. A broken executor can do no more, and each file has a process of its own."""
    left = dict(enumerate(tasks))
    try:
        for index, record, is_lost in _submitted(left, executor):
            if not is_lost:
                del left[index]
                yield index, record
        for index in list(left):
            for _, record, _ in _submitted({index: left[index]}, executor, _perform_again):
                del left[index]
                yield index, record
    except BrokenExecutor:
        with Processes() as processes:
            yield from ((index, _by_itself(processes, task)) for index, task in left.items())


def _submitted(
    tasks: Mapping[int, FileTask],
    executor: Executor,
    work: Callable[[FileTask], Record] = perform,
) -> Generator[tuple[int, Record, bool]]:
    """Index, record, and whether the executor did not finish it, whatever it says of a worker that
    died. Raises BrokenExecutor, of an executor that can do no more, and what is wrong with all
    files."""
    futures: dict[Future[Record], tuple[int, FileTask]] = {}
    try:
        for index, task in tasks.items():
            futures[executor.submit(work, task)] = index, task
        for future in as_completed(futures):
            index, task = futures.pop(future)
            yield index, *_record_of(task, future)
    except BrokenExecutor:
        yield from _finished(futures)
        raise
    finally:
        for future in futures:
            future.cancel()


def _perform_again(task: FileTask) -> Record:
    """A function of its own, as Dask remembers what came of the same function of the same task."""
    return perform(task)


def _finished(
    futures: Mapping[Future[Record], tuple[int, FileTask]],
) -> Iterator[tuple[int, Record, bool]]:
    """What was done before the executor broke."""
    for future, (index, _) in futures.items():
        if future.done() and not future.cancelled() and future.exception() is None:
            yield index, future.result(), False


def _record_of(task: FileTask, future: Future[Record]) -> tuple[Record, bool]:
    try:
        return future.result(), False
    except (BrokenExecutor, InvalidParameter, ImportError):
        raise
    except Exception as error:  # noqa: BLE001 - each executor has its own
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        return failed(task, f"the executor did not finish it ({reason})"), True


def _by_processes(tasks: Iterable[FileTask], jobs: int) -> Iterator[Ended]:
    """Each file by one of so many processes, whose death is an error of that file."""
    with (
        ThreadPoolExecutor(jobs) as threads,
        Processes() as processes,
        closing(
            _submitted(dict(enumerate(tasks)), threads, partial(_by_itself, processes))
        ) as found,
    ):
        yield from ((index, record) for index, record, _ in found)


def _by_itself(processes: Processes, task: FileTask) -> Record:
    """Twice where the process dies: it may have been killed for what others took."""
    for _ in range(2):
        try:
            return processes.call(perform.__module__, perform.__name__, task)
        except ProcessDied:
            continue
    return failed(task, "the process that worked on it died, perhaps for want of memory")
