"""Files that are written whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterable
from contextlib import suppress
from functools import partial
from pathlib import Path


def write_whole(path: Path, content: bytes | Iterable[bytes]) -> None:
    """Writes the file whole or not at all: what stood there stays until the new one is complete.
    Blocks are written as they come."""
    file = path.resolve()  # a link stays a link
    if file.exists() and not file.is_file():  # such as a device, which a file would replace
        raise OSError(errno.EINVAL, "This is not a file", str(path))
    # A name of its own: others may write the same file at the same time.
    unfinished = file.with_name(f".symsurf-{os.urandom(8).hex()}.partial")
    before = file.stat() if file.exists() else None
    opener = partial(os.open, mode=0o666 if before is None else 0o600)
    try:
        with open(unfinished, "xb", opener=opener) as new:
            if before is not None:
                _hand_over(unfinished, before)
            new.writelines([content] if isinstance(content, bytes) else content)
        unfinished.replace(file)
    except BaseException as error:
        with suppress(OSError):
            unfinished.unlink()
        if isinstance(error, OSError):  # which names the partial file
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise


def _hand_over(file: Path, before: os.stat_result) -> None:
    """To those who may read and write what stood there."""
    with suppress(OSError, AttributeError):  # root may give files away; Windows has no owners
        os.chown(file, before.st_uid, before.st_gid)
    file.chmod(stat.S_IMODE(before.st_mode))
