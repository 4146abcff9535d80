"""Points of files larger than memory, some of them at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from ...base import own_process
from ...base.options import Reading
from ..errors import broken, naming
from ..formats import FORMATS, limits_of, require_packages, suffix_of
from ..location import require_file

ROWS = 1 << 20
"""Points at a time: 24 MB of coordinates."""


@dataclass(frozen=True)
class FileChunks:
    """The points of a file, in its order and unit."""

    count: int | None
    """Of the points that its header promises; None where it does not say."""
    start: Callable[[], Iterator[NDArray[np.float64]]]
    """Reads them from the first on, (n, 3) at a time."""
    system: bytes = b""
    """The coordinate reference system that the header names, as it stands there; none: empty."""


# By suffix the module that has ``chunks_of(path, reading)``, and the packages that it imports, whose
# readers have a process of their own.
_READERS = {
    ".las": ("las_chunks", ()),
    ".laz": ("laz_chunks", ("laspy", "lazrs")),
    ".npy": ("npy_chunks", ()),
    ".ply": ("ply_chunks", ()),
    ".e57": ("e57_chunks", ("pye57",)),
    ".pvtp": ("vtk_chunks", ("pyvista",)),
    ".vtkhdf": ("vtk_chunks", ("pyvista",)),
}


def is_chunked(path: Path) -> bool:
    """Whether its format can be read some points at a time."""
    return suffix_of(path) in _READERS


def chunks_of(path: Path, reading: Reading | None = None) -> FileChunks:
    """Raises InvalidInput, naming the file, for what cannot be read so; whoever reads the chunks, too."""
    suffix = suffix_of(path)
    if suffix not in _READERS:
        whole = " (it can be read whole, with symsurf.read)" if suffix in FORMATS else ""
        raise InvalidInput(
            f"{path}: suffix '{suffix}' is none of {' '.join(_READERS)}, which are read in chunks{whole}"
        )
    module, packages = _READERS[suffix]
    given = module, path.absolute(), reading or Reading()

    def start() -> Iterator[NDArray[np.float64]]:
        with naming(path), broken(suffix[1:].upper()):
            if packages:
                limits = limits_of(path.stat().st_size)
                yield from own_process.stream(__name__, rows.__name__, *given, **limits)
            else:
                yield from rows(*given)

    with naming(path), broken(suffix[1:].upper()):
        require_file(str(path))
        try:
            require_packages(suffix[1:].upper(), packages, " ".join(packages))
        except ImportError as error:
            raise InvalidInput(str(error)) from error
        count, system = (
            own_process.call(__name__, head.__name__, *given, **limits_of(path.stat().st_size))
            if packages
            else head(*given)
        )
    return FileChunks(count, start, system)


def head(module: str, path: Path, reading: Reading) -> tuple[int | None, bytes]:
    """How many points a file has, and in which system, by the module of its format."""
    found = _chunks(module, path, reading)
    return found.count, found.system


def rows(module: str, path: Path, reading: Reading) -> Iterator[NDArray[np.float64]]:
    """Its points."""
    with broken(suffix_of(path)[1:].upper()):
        yield from _chunks(module, path, reading).start()


def _chunks(module: str, path: Path, reading: Reading) -> FileChunks:
    with broken(suffix_of(path)[1:].upper()):
        return import_module(f"{__name__}.{module}").chunks_of(path, reading)


def mapped_rows(path: Path, row: np.dtype, start: int, count: int) -> Iterator[NDArray[Any]]:
    """So many rows of a file from a byte on, some at a time, in place. Each part is mapped anew: what
    was read of a mapping counts as memory of the process."""
    for begin in range(0, count, ROWS):
        size = min(ROWS, count - begin)
        yield np.memmap(path, row, "r", start + begin * row.itemsize, (size,))
