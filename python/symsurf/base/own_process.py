"""Calling functions in processes of their own, which may die, hang or eat memory without harm to this
one."""

from __future__ import annotations

import atexit
import os
import pickle
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from io import BufferedReader
from math import ceil
from pathlib import Path
from queue import SimpleQueue
from threading import Thread, Timer
from time import process_time
from types import TracebackType
from typing import Any
from weakref import WeakSet

from .._core import memory_limit

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

_PATIENCE = 4  # s of waiting for one of a processor, which others use too


class ProcessDied(Exception):
    """The process ended without an answer."""


class Processes:
    """Processes that each work on one call at a time, and stay for the next.

    They import this package, nothing of the caller's script, and no module of the current folder.
    They end with this process, or when the context is left. In a host that has no Python to run, such
    as one it is built into, the functions run in this process.

    Args:
        folder: that they are in; without it the current one, which Windows keeps until they end.
    """

    def __init__(self, folder: str | None = None) -> None:
        self._folder = folder
        self._idle: list[_Process] = []
        self._living: set[_Process] = set()
        self._has_ended = False
        _groups.add(self)

    def call(
        self,
        module: str,
        function: str,
        *arguments: Any,
        memory: int | None = None,
        seconds: float | None = None,
    ) -> Any:
        """What the function, of these names, returns or raises there.

        Args:
            memory: the most bytes that the process may have; without it those of the machine. Windows
                has no such limit.
            seconds: of a processor until it is ended; without it, it has any time.

        Raises ProcessDied.
        """
        *_, (_, value) = self._answers(module, function, arguments, memory, seconds)
        return value

    def stream(
        self,
        module: str,
        function: str,
        *arguments: Any,
        memory: int | None = None,
        seconds: float | None = None,
    ) -> Iterator[Any]:
        """What the generator function, of these names, yields or raises there. The arguments are those
        of ``call``; each item has the time anew. Raises ProcessDied."""
        for is_item, value in self._answers(module, function, arguments, memory, seconds):
            if is_item:
                yield value

    def _answers(
        self,
        module: str,
        function: str,
        arguments: tuple[Any, ...],
        memory: int | None,
        seconds: float | None,
    ) -> Iterator[tuple[bool, Any]]:
        """Items, and then what is returned, with whether each is an item."""
        python = _python()
        if python is None:
            value = getattr(import_module(module), function)(*arguments)
            if isinstance(value, Iterator):
                yield from ((True, item) for item in value)
                value = None
            yield False, value
            return
        request = pickle.dumps((module, function, arguments, memory, seconds))
        patience = None if seconds is None else _PATIENCE * seconds
        process, kind, value = self._begun(python, request, patience)
        try:
            while kind == _ITEM:
                yield True, value
                kind, value = process.answer(patience)
        except BaseException:  # such as the caller's, who has seen enough
            self._end(process)
            raise
        self._idle.append(process)
        if kind == _ERROR:
            raise value
        yield False, value

    def _begun(
        self, python: str, request: bytes, patience: float | None
    ) -> tuple[_Process, int, Any]:
        """A process that works on the request, and its first answer."""
        while True:
            if self._has_ended:
                raise ProcessDied
            try:
                process = self._idle.pop()
            except IndexError:
                process = _Process(python, self._folder)
                self._living.add(process)
            has_answered = process.answers > 0
            try:
                process.ask(request)
                return process, *process.answer(patience)
            except BaseException as error:
                self._end(process)
                # It may have died of an earlier call.
                if not isinstance(error, ProcessDied) or not has_answered:
                    raise

    def _end(self, process: _Process) -> None:
        process.end()
        self._living.discard(process)

    def end(self) -> None:
        """Ends all, whatever they work on: those who wait for them raise ProcessDied."""
        self._has_ended = True
        for process in list(self._living):
            process.kill()

    def forget(self) -> None:
        """Of a fork, whose parent has the processes."""
        for process in list(self._living):
            process.forget()
        self._idle.clear()
        self._living.clear()

    def __enter__(self) -> Processes:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.end()


class _Process:
    def __init__(self, python: str, folder: str | None) -> None:
        import subprocess  # `import symsurf` does not wait for it

        # Isolated, so that no module comes from the current folder, which may be one of data; the
        # terminal's interrupt is for who waits.
        start = (
            "import signal, sys; signal.signal(signal.SIGINT, signal.SIG_IGN); "
            f"sys.path[:] = {_import_paths()!a}; from {__name__} import serve; serve()"
        )
        utf8 = ["-X", "utf8"] if sys.flags.utf8_mode else []
        self.answers = 0
        self._child = subprocess.Popen(
            [python, "-I", *utf8, "-c", start],
            cwd=folder,
            bufsize=0,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        self._answers = BufferedReader(self._child.stdout)  # type: ignore[type-var]

    def ask(self, request: bytes) -> None:
        assert self._child.stdin is not None
        try:
            left = memoryview(request)
            while left:
                left = left[self._child.stdin.write(left) :]
        except OSError as error:  # it ended while it was idle
            raise ProcessDied from error

    def answer(self, patience: float | None) -> tuple[int, Any]:
        """Its kind, and what it is."""
        watch = None if patience is None else Timer(patience, self._child.kill)
        if watch is not None:
            watch.daemon = True
            watch.start()
        try:
            kind, value = pickle.load(self._answers)
        except (EOFError, pickle.UnpicklingError, OSError, ValueError) as error:
            raise ProcessDied from error
        finally:
            if watch is not None:
                watch.cancel()
        self.answers += 1
        return kind, value

    def kill(self) -> None:
        self._child.kill()
        self._child.wait()

    def end(self) -> None:
        self.kill()
        self.forget()

    def forget(self) -> None:
        """Closes what leads to it, without the locks that a thread may have held before a fork."""
        for pipe in (self._child.stdin, self._child.stdout):
            assert pipe is not None
            pipe.close()
        self._child.returncode = self._child.returncode or 0


@contextmanager
def one_more_file(is_limited: bool = True) -> Iterator[None]:
    """Code within can open a single file at a time, so that what is in it leads to no other. Windows
    has no such limit."""
    if resource is None or not is_limited:
        yield
        return
    free = os.open(os.devnull, os.O_RDONLY)
    os.close(free)
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(free + 1, before[0]), before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


_groups: WeakSet[Processes] = WeakSet()
COMMON = Processes(os.path.abspath(os.sep))
"""Those of readers, which are given whole paths."""
call, stream = COMMON.call, COMMON.stream


@atexit.register
def _end_all() -> None:
    for group in list(_groups):
        group.end()


def _forget_all() -> None:
    for group in list(_groups):
        group.forget()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_all)


def _python() -> str | None:
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    for path in (
        Path(sys.executable or "/"),
        Path(sys.exec_prefix, "bin", version),
        Path(sys.exec_prefix, "python.exe"),
    ):
        if path.name.lower().startswith("python") and path.is_file():
            return str(path)
    return None


def _import_paths() -> list[str]:
    """Where this process imports from, without the current folder."""
    try:
        here = os.path.realpath(os.curdir)
    except OSError:  # it was removed
        here = ""
    own = str(Path(__file__).parents[2])
    paths = [path for path in sys.path if os.path.isabs(path) and os.path.realpath(path) != here]
    return paths if own in paths else [own, *paths]


_ITEM, _VALUE, _ERROR = range(3)


def serve() -> None:
    """The other end of ``call`` and ``stream``: answers until its parent is gone."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what libraries print is no answer
    requests: SimpleQueue[Any] = SimpleQueue()
    Thread(target=_receive, args=(requests,), daemon=True).start()
    limits = _Limits()
    while True:
        module, function, arguments, memory, seconds = requests.get()
        try:
            limits.set(memory, seconds)
            value = getattr(import_module(module), function)(*arguments)
            if isinstance(value, Iterator):
                for item in value:
                    _send(answers, _ITEM, item)
                    limits.set(memory, seconds)
                value = None
            _send(answers, _VALUE, value)
        except Exception as error:  # noqa: BLE001 - it is the caller's to judge
            _send(answers, _ERROR, _sendable(error))
        except BaseException as error:  # noqa: BLE001 - and so are panics of libraries in Rust
            _send(answers, _ERROR, RuntimeError(str(error)))


def _receive(requests: SimpleQueue[Any]) -> None:
    while True:
        try:
            requests.put(pickle.load(sys.stdin.buffer))
        except BaseException:  # noqa: BLE001 - such as the end: nobody waits for what is worked on
            os._exit(0)


def _send(answers: Any, kind: int, value: Any) -> None:
    try:
        pickle.dump((kind, value), answers, pickle.HIGHEST_PROTOCOL)
        answers.flush()
    except BrokenPipeError:
        os._exit(1)


def _sendable(error: Exception) -> Exception:
    """What another process can make again."""
    try:
        return pickle.loads(pickle.dumps(error))
    except Exception:  # noqa: BLE001 - such as of exceptions with arguments of their own
        return RuntimeError(f"{type(error).__name__}: {error}")


class _Limits:
    """Of this process: what it may take for a call, within those that it was started with."""

    def __init__(self) -> None:
        self._machine = memory_limit()
        if resource is not None:
            resource.setrlimit(
                resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1])
            )
            self._memory = resource.getrlimit(resource.RLIMIT_AS)
            self._seconds = resource.getrlimit(resource.RLIMIT_CPU)

    def set(self, memory: int | None, seconds: float | None) -> None:
        if resource is None:
            return
        most = self._machine if memory is None else min(self._machine, memory)
        try:
            resource.setrlimit(resource.RLIMIT_AS, (most, self._memory[1]))
        except ValueError:
            if sys.platform != "darwin":  # which refuses most limits, and keeps none
                raise
        given, hard = self._seconds
        if seconds is not None:
            end = ceil(process_time() + seconds)
            given = end if given == resource.RLIM_INFINITY else min(end, given)
        resource.setrlimit(resource.RLIMIT_CPU, (given, hard))
