"""Calling a function in a process of its own, which may die or eat memory without harm to this one."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any


class ProcessDied(Exception):
    """The process ended without an answer."""


def call(module: str, function: str, *arguments: Any, memory: int | None = None) -> Any:
    """What the function gives or raises there. The process imports this package, and nothing of the
    caller's script.

    Args:
        module, function: their names.
        memory: the most bytes that the process may have.

    Raises ProcessDied. In a host that has no Python to run, such as one it is built into, the function
    runs in this process.
    """
    python = _python()
    if python is None:
        return getattr(import_module(module), function)(*arguments)
    answer, to_parent = os.pipe()
    request = pickle.dumps((module, function, arguments, memory))
    command = [python, "-c", f"from {__name__} import answer; answer({to_parent})"]
    paths = [str(Path(__file__).parents[1]), *filter(None, sys.path)]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(paths)}
    try:
        child = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=[to_parent],
            env=environment,
        )
    finally:
        os.close(to_parent)
    with child, open(answer, "rb") as stream:
        try:
            assert child.stdin is not None
            child.stdin.write(request)
            child.stdin.close()
            is_error, value = pickle.load(stream)
        except (EOFError, pickle.UnpicklingError, BrokenPipeError) as error:
            raise ProcessDied from error
    if is_error:
        raise value
    return value


def _python() -> str | None:
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    for path in (Path(sys.executable or "/"), Path(sys.exec_prefix, "bin", version)):
        if path.name.startswith("python") and path.is_file():
            return str(path)
    return None


def answer(descriptor: int) -> None:
    """The other end of ``call``."""
    module, function, arguments, memory = pickle.load(sys.stdin.buffer)
    if memory is not None:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    try:
        value = (False, getattr(import_module(module), function)(*arguments))
    except Exception as error:  # the caller's to judge
        value = (True, error)
    except BaseException as error:  # so are panics of libraries in Rust
        value = (True, RuntimeError(str(error)))
    with open(descriptor, "wb") as stream:
        stream.write(pickle.dumps(value))
