"""Files: where they lie, which may be opened, and how much of them fits into memory."""

from __future__ import annotations

import gzip
import os
import re
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path, PurePath
from shutil import copyfile
from typing import IO, BinaryIO, cast

from .._core import InvalidInput, memory_limit
from ..base.options import Reading
from .formats import PACKED

_BLOCK = 1 << 20  # bytes that are unpacked at once


@contextmanager
def located(name: str, suffix: str, stream: BinaryIO | None) -> Iterator[Path]:
    """The file itself where its name has the suffix, otherwise a temporary one, unpacked.

    Raises InvalidInput for what is no file, is empty, or is larger than half of the memory.
    """
    if stream is None:
        require_file(name)
    plain = suffix.removesuffix(PACKED)
    if stream is None and suffix == plain == Path(name).suffix.lower():
        _require_own(Path(name))
        yield Path(name)
        return
    from tempfile import TemporaryDirectory  # few files need it

    with TemporaryDirectory(prefix="symsurf-") as folder:
        file = Path(folder) / f"input{plain}"
        if stream is None and suffix == plain:
            try:
                file.symlink_to(os.path.abspath(name))
            except OSError:  # Windows asks for a right
                copyfile(name, file)
        else:
            packed = stream or name
            with (
                file.open("wb") as copy,
                nullcontext(stream) if suffix == plain else gzip.open(packed) as content,
            ):
                copy_bounded(cast(BinaryIO, content), copy)
        _require_own(file)
        yield file


def referenced(name: str, path: Path, reading: Reading) -> Path:
    """The file that another names. Raises InvalidInput unless it is a regular one, and lies beside or
    below the other, links followed, or may lie anywhere."""
    named = path.parent / name
    if not reading.external_files and (
        leads_away(named, path) or path.parent.resolve() not in named.resolve().parents
    ):
        raise InvalidInput(
            f"it names the file {name!r:.80}, which is neither beside nor below it; "
            "external_files=True allows that"
        )
    file = named.resolve()
    if not file.is_file():
        raise InvalidInput(f"it needs the file {name!r:.80}, which is not there, or no file")
    return file


def leads_away(named: PurePath, path: PurePath) -> bool:
    """Whether a file lies on another drive or, on Windows, on another machine: to look for it there
    would already log in."""
    return named.drive.lower() != path.drive.lower()


# How files begin that stand where another should, in small letters.
_OTHERS = {
    b"version https://git-lfs.github.com": "a pointer of Git LFS, not the file: `git lfs pull` brings it",
    b"<!doctype html": "an HTML page, such as a download that failed",
    b"<html": "an HTML page, such as a download that failed",
    b"%pdf-": "a PDF document",
    b"\x1f\x8b": "packed with gzip: its name should end with .gz",
    BOM_UTF16_LE: "text in UTF-16; UTF-8 can be read",
    BOM_UTF16_BE: "text in UTF-16; UTF-8 can be read",
}


# Letters with zeros between.
_UTF_16 = re.compile(rb"(?:[\t\r\n -~]\0){4}|(?:\0[\t\r\n -~]){4}")


def _require_own(file: Path) -> None:
    with file.open("rb") as content:
        whole = content.read(256)
    start = whole.removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    for beginning, what in _OTHERS.items():
        if start.startswith(beginning):
            raise InvalidInput(f"this is {what}")
    if _UTF_16.match(whole) and file.suffix.lower() != ".stl":  # whose header may be so
        raise InvalidInput(f"this is {_OTHERS[BOM_UTF16_LE]}")


def require_file(name: str) -> None:
    if not os.path.exists(name):
        raise InvalidInput("there is no such file")
    if not os.path.isfile(name):
        raise InvalidInput("this is not a file")
    if os.path.getsize(name) == 0:
        raise InvalidInput("the file is empty")


_LONGEST_TABLE = 1 << 25  # bytes, of a million landmarks: Python takes thirty times as many
# What a file may honestly stand for: of a small one this, of others zlib's most for each byte.
_HONEST, _HONEST_A_BYTE = 1 << 29, 1000


def require_memory(size: int, file_size: int | None = None) -> None:
    """Raises InvalidInput where a file takes more bytes than half of the memory, or far more than it
    has, where that is given."""
    allowed, why = memory_limit() // 2, "half of the memory"
    if file_size is not None and (honest := max(_HONEST, _HONEST_A_BYTE * file_size)) < allowed:
        allowed, why = honest, f"of a file of {file_size} bytes"
    if size > allowed:
        raise InvalidInput(f"it holds more than {allowed} bytes, {why}, which is the most allowed")


def content_of(path: Path) -> bytes:
    """Raises InvalidInput where it is larger than half of the memory."""
    require_memory(path.stat().st_size)
    return path.read_bytes()


def text_of(path: Path) -> str:
    """The text of a table of landmarks. Raises InvalidInput where it is longer than any of these."""
    if (size := path.stat().st_size) > _LONGEST_TABLE:
        raise InvalidInput(f"it has {size} bytes; allowed are {_LONGEST_TABLE}")
    return path.read_text("utf-8-sig")


def copy_bounded(content: BinaryIO, copy: IO[bytes]) -> None:
    """As the core does, takes no more than half of the memory: few bytes may unpack to very many."""
    size = 0
    while block := content.read(_BLOCK):
        size += copy.write(block)
        require_memory(size)
    copy.flush()
    if size == 0:
        raise InvalidInput("the file is empty")
