"""Calling functions in a process of its own, which may die or eat memory without harm to this one."""

from __future__ import annotations

import atexit
import os
import pickle
import sys
from importlib import import_module
from pathlib import Path
from select import select
from threading import Lock
from typing import Any

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]


class ProcessDied(Exception):
    """The process ended without an answer."""


def call(
    module: str,
    function: str,
    *arguments: Any,
    memory: int | None = None,
    seconds: float | None = None,
) -> Any:
    """What the function, of these names, gives or raises there.

    The process imports this package, and nothing of the caller's script. It stays for the next call,
    and ends with this one. In a host that has no Python to run, such as one it is built into, and on
    Windows, where memory has no limit to set, the function runs in this process.

    Args:
        memory: the most bytes that the process may have; without it those of the machine.
        seconds: until it is ended; without it, it has any time.

    Raises ProcessDied.
    """
    global _process
    python = _python()
    if python is None:
        return getattr(import_module(module), function)(*arguments)
    with _lock:
        while True:
            process = _process
            if process is None or process.parent != os.getpid():
                process = _Process(python)
            _process = None
            try:
                is_error, value = process.answer(module, function, arguments, memory, seconds)
                break
            except ProcessDied:
                if not process.answers:  # else perhaps of an earlier call
                    raise
        _process = process
    if is_error:
        raise value
    return value


class _Process:
    def __init__(self, python: str) -> None:
        import subprocess  # `import symsurf` does not wait for it

        self.parent, self.answers = os.getpid(), 0
        answers, to_parent = os.pipe()
        paths = [str(Path(__file__).parents[2]), *filter(None, sys.path)]
        self._child = subprocess.Popen(
            [python, "-c", f"from {__name__} import serve; serve({to_parent})"],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=[to_parent],
            env=os.environ | {"PYTHONPATH": os.pathsep.join(paths)},
        )
        os.close(to_parent)
        self._answers = os.fdopen(answers, "rb")

    def answer(self, *request: Any) -> tuple[bool, Any]:
        assert self._child.stdin is not None
        *asked, seconds = request
        try:
            self._child.stdin.write(pickle.dumps(asked))
            self._child.stdin.flush()
            if not select([self._answers], [], [], seconds)[0]:
                raise EOFError
            value = pickle.load(self._answers)
        except (EOFError, pickle.UnpicklingError, BrokenPipeError) as error:
            self.end()
            raise ProcessDied from error
        self.answers += 1
        return value

    def end(self) -> None:
        self._answers.close()
        self._child.kill()
        self._child.communicate()


_process: _Process | None = None
_lock = Lock()


@atexit.register
def _end() -> None:
    if _process is not None and _process.parent == os.getpid():
        _process.end()


def _python() -> str | None:
    if resource is None:
        return None
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    for path in (Path(sys.executable or "/"), Path(sys.exec_prefix, "bin", version)):
        if path.name.startswith("python") and path.is_file():
            return str(path)
    return None


def _limit_memory(limit: int, hard: int) -> None:
    try:
        resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
    except ValueError:
        if sys.platform != "darwin":  # which refuses most limits, and keeps none
            raise


def serve(descriptor: int) -> None:
    """The other end of ``call``: answers until its parent is gone."""
    inherited, hard = resource.getrlimit(resource.RLIMIT_AS)
    machine = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    most = machine if inherited == resource.RLIM_INFINITY else min(machine, inherited)
    with open(descriptor, "wb") as answers:
        while True:
            try:
                module, function, arguments, memory = pickle.load(sys.stdin.buffer)
            except EOFError:
                return
            limit = most if memory is None else min(most, memory)
            _limit_memory(limit, hard)
            try:
                value = (False, getattr(import_module(module), function)(*arguments))
            except Exception as error:  # noqa: BLE001 - it is the caller's to judge
                value = (True, error)
            except BaseException as error:  # noqa: BLE001 - and so are panics of libraries in Rust
                value = (True, RuntimeError(str(error)))
            answers.write(pickle.dumps(value))
            answers.flush()
