"""A file with the suffix of its format, which the readers tell it by."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from .._core import InvalidInput
from .formats import PACKED

if TYPE_CHECKING:
    import bz2
    import gzip

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
        yield Path(name)
        return
    import gzip  # here: few files need them
    from tempfile import TemporaryDirectory

    with TemporaryDirectory(prefix="symsurf-") as folder:
        file = Path(folder) / f"input{plain}"
        if suffix != plain:
            with gzip.open(stream or name) as content:
                copy_bounded(content, file)
        elif stream is None:
            file.symlink_to(os.path.abspath(name))
        else:
            copy_bounded(stream, file)
        yield file


def _require_file(name: str) -> None:
    if not os.path.exists(name):
        raise InvalidInput("there is no such file")
    if not os.path.isfile(name):
        raise InvalidInput("this is not a file")
    if os.path.getsize(name) == 0:
        raise InvalidInput("the file is empty")


def copy_bounded(content: BinaryIO | gzip.GzipFile | bz2.BZ2File, file: Path) -> None:
    """As the core does, takes no more than half of the memory: few bytes may unpack to very many."""
    allowed = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
    with file.open("wb") as copy:
        while block := content.read(_BLOCK):
            copy.write(block)
            if copy.tell() > allowed:
                raise InvalidInput(
                    f"it holds more than {allowed} bytes, half of the memory, which is the most allowed"
                )
    if file.stat().st_size == 0:
        raise InvalidInput("the file is empty")
