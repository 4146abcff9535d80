"""Points of files larger than memory, some of them at a time."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from ..formats import FORMATS, suffix_of

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


# By suffix the module that has ``chunks_of(path)``, and the packages that it imports.
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


def chunks_of(path: Path) -> FileChunks:
    """Raises InvalidInput, naming the file, for what cannot be read so."""
    suffix = suffix_of(path)
    if suffix not in _READERS:
        whole = " (it can be read whole, with symsurf.read)" if suffix in FORMATS else ""
        raise InvalidInput(
            f"{path}: suffix '{suffix}' is none of {' '.join(_READERS)}, which are read in chunks{whole}"
        )
    module, packages = _READERS[suffix]
    for package in packages:
        if find_spec(package) is None:
            raise InvalidInput(
                f"{path}: the package {package} is not installed: pip install {package}"
            )
    try:
        return import_module(f"{__name__}.{module}").chunks_of(path)
    except (InvalidInput, OSError, ValueError, LookupError, struct.error) as error:
        raise InvalidInput(f"{path}: {error}") from error


def mapped_rows(path: Path, row: np.dtype, start: int, count: int) -> Iterator[NDArray[Any]]:
    """So many rows of a file from a byte on, some at a time, in place. Each part is mapped anew: what
    was read of a mapping counts as memory of the process."""
    for begin in range(0, count, ROWS):
        size = min(ROWS, count - begin)
        yield np.memmap(path, row, "r", start + begin * row.itemsize, (size,))
