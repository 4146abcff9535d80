"""One process at a time that writes a file row by row."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .._core import InvalidParameter

if sys.platform == "win32":
    import msvcrt

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]


@contextmanager
def sole_writer(path: Path) -> Iterator[None]:
    """Raises InvalidParameter while another process has entered this for the same file. The system
    releases what a process that dies holds; where it locks no files, all may enter."""
    file = path.resolve()
    lock = file.with_name(f".{file.name}.lock")
    try:
        descriptor = _held(lock)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error
    if descriptor is None:
        raise InvalidParameter(
            f"{path} is being written by another run; allowed is another table, or to wait for its end"
        )
    try:
        yield
    finally:
        if fcntl is not None:  # as long as it is held, so that nobody holds a file that is gone
            lock.unlink(missing_ok=True)
        os.close(descriptor)
        with suppress(OSError):  # Windows removes no file that is open, and none that another holds
            if fcntl is None:
                lock.unlink()


def _held(lock: Path) -> int | None:
    """A descriptor that holds the lock; None where another does."""
    # No link, which others may have laid in a folder that is theirs, too.
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
    while True:
        descriptor = os.open(lock, flags, 0o666)
        if not _can_hold(descriptor):
            os.close(descriptor)
            return None
        if fcntl is None or _is_file(descriptor, lock):
            return descriptor
        os.close(descriptor)  # who held it has removed it


def _can_hold(descriptor: int) -> bool:
    try:
        if sys.platform == "win32":
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        elif fcntl is not None:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:  # also of a file system without locks
        return sys.platform != "win32" and not isinstance(error, BlockingIOError)
    return True


def _is_file(descriptor: int, path: Path) -> bool:
    with suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(descriptor), path.stat())
    return False
