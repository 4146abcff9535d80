"""PLY, binary, in place."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from ..ply_types import TYPES
from . import ROWS, FileChunks

_LONGEST_HEADER = 1 << 16  # bytes


def chunks_of(path: Path) -> FileChunks:
    with path.open("rb") as file:
        head = file.read(_LONGEST_HEADER)
    header, separator, _ = head.partition(b"end_header")
    if not header.startswith(b"ply") or not separator:
        raise InvalidInput("this is no PLY file: its header does not end")
    start = head.index(b"\n", len(header)) + 1
    lines = [line.split() for line in header.splitlines()]
    count, row = _vertices(lines, _byte_order(lines))
    if path.stat().st_size < start + count * row.itemsize:
        raise InvalidInput(f"the file is truncated: it holds fewer than its {count} vertices")

    def rows() -> Iterator[NDArray[np.float64]]:
        for begin in range(0, count, ROWS):
            size = min(ROWS, count - begin)
            # Mapped anew: what was read of a mapping counts as memory of the process.
            vertices = np.memmap(path, row, "r", start + begin * row.itemsize, (size,))
            yield np.stack([vertices[axis] for axis in "xyz"], axis=1).astype(np.float64)

    return FileChunks(count, rows)


def _byte_order(lines: list[list[bytes]]) -> str:
    encoding = next((words[1] for words in lines if words[:1] == [b"format"]), b"missing").decode()
    orders = {"binary_little_endian": "<", "binary_big_endian": ">"}
    if encoding not in orders:
        raise InvalidInput(
            f"the format is {encoding}; in chunks {' and '.join(orders)} can be read"
        )
    return orders[encoding]


def _vertices(lines: list[list[bytes]], order: str) -> tuple[int, np.dtype]:
    """How many there are, and what stands of each. Raises InvalidInput unless they come first, with
    x, y and z, and without lists."""
    elements = [number for number, words in enumerate(lines) if words[:1] == [b"element"]]
    if not elements or lines[elements[0]][1] != b"vertex":
        raise InvalidInput("the vertices are not the first element; in chunks they have to be")
    end = elements[1] if len(elements) > 1 else len(lines)
    properties = [words[1:] for words in lines[elements[0] : end] if words[:1] == [b"property"]]
    types = [TYPES.get(words[0].decode()) for words in properties]
    if None in types:
        raise InvalidInput("the vertices have a list, or a property of an unknown type")
    row = np.dtype(
        [(words[-1].decode(), f"{order}{type}") for words, type in zip(properties, types)]
    )
    if not {"x", "y", "z"} <= {*(row.names or ())}:
        raise InvalidInput("the vertices lack x, y or z")
    return int(lines[elements[0]][2]), row
