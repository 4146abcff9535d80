"""A file with the suffix of its format, which the readers tell it by."""

from __future__ import annotations

import gzip
import os
from collections.abc import Iterator
from contextlib import contextmanager
from io import BufferedIOBase
from pathlib import Path
from typing import BinaryIO

from .._core import InvalidInput
from .formats import PACKED

_BLOCK = 1 << 20  # bytes that are unpacked at once


@contextmanager
def located(name: str, suffix: str, stream: BinaryIO | None) -> Iterator[Path]:
    """The file itself where its name has the suffix, otherwise a temporary one, unpacked.

    Raises InvalidInput for what is no file, is empty, or is larger than half of the memory.
    """
    if stream is None:
        _require_file(name)
    plain = suffix.removesuffix(PACKED)
    if stream is None and suffix == plain == Path(name).suffix.lower():
        _require_own(Path(name))
        yield Path(name)
        return
    from tempfile import TemporaryDirectory  # few files need it

    with TemporaryDirectory(prefix="symsurf-") as folder:
        file = Path(folder) / f"input{plain}"
        if suffix != plain:
            with gzip.open(stream or name) as content:
                copy_bounded(content, file)
        elif stream is None:
            file.symlink_to(os.path.abspath(name))
        else:
            copy_bounded(stream, file)
        _require_own(file)
        yield file


# How files begin that stand where another should, in small letters.
_OTHERS = {
    b"version https://git-lfs.github.com": "a pointer of Git LFS, not the file: `git lfs pull` brings it",
    b"<!doctype html": "an HTML page, such as a download that failed",
    b"<html": "an HTML page, such as a download that failed",
    b"%pdf-": "a PDF document",
    b"\x1f\x8b": "packed with gzip: its name should end with .gz",
    b"\xff\xfe": "text in UTF-16; UTF-8 can be read",
    b"\xfe\xff": "text in UTF-16; UTF-8 can be read",
}


def _require_own(file: Path) -> None:
    with file.open("rb") as content:
        start = content.read(256).removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    for beginning, what in _OTHERS.items():
        if start.startswith(beginning):
            raise InvalidInput(f"this is {what}")


def _require_file(name: str) -> None:
    if not os.path.exists(name):
        raise InvalidInput("there is no such file")
    if not os.path.isfile(name):
        raise InvalidInput("this is not a file")
    if os.path.getsize(name) == 0:
        raise InvalidInput("the file is empty")


def require_memory(size: int) -> None:
    """Raises InvalidInput where a file unpacks to more bytes than half of the memory."""
    allowed = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
    if size > allowed:
        raise InvalidInput(
            f"it holds more than {allowed} bytes, half of the memory, which is the most allowed"
        )


def copy_bounded(content: BinaryIO | BufferedIOBase, file: Path) -> None:
    """As the core does, takes no more than half of the memory: few bytes may unpack to very many."""
    with file.open("wb") as copy:
        while block := content.read(_BLOCK):
            copy.write(block)
            require_memory(copy.tell())
    if file.stat().st_size == 0:
        raise InvalidInput("the file is empty")
