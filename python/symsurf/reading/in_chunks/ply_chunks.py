"""PLY, binary, in place."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from ...base.options import Reading
from ..ply_header import END, TYPES, Element, elements_of
from . import FileChunks, mapped_rows

_LONGEST_HEADER = 1 << 16  # bytes


def chunks_of(path: Path, reading: Reading) -> FileChunks:
    with path.open("rb") as file:
        head = file.read(_LONGEST_HEADER)
    end = END.search(head)
    if not head.startswith(b"ply") or end is None:
        raise InvalidInput("this is no PLY file: its header does not end")
    lines = head[: end.start()].splitlines()
    vertices = next(iter(elements_of(lines)), None)
    if vertices is None or vertices.name != b"vertex":
        raise InvalidInput("the vertices are not the first element; in chunks they have to be")
    row = _row(vertices, _byte_order(lines))
    if path.stat().st_size < end.end() + vertices.count * row.itemsize:
        raise InvalidInput(
            f"the file is truncated: it holds fewer than its {vertices.count} vertices"
        )

    def rows() -> Iterator[NDArray[np.float64]]:
        for part in mapped_rows(path, row, end.end(), vertices.count):
            yield np.stack([part[axis] for axis in "xyz"], axis=1).astype(np.float64)

    return FileChunks(vertices.count, rows)


def _byte_order(lines: list[bytes]) -> str:
    formats = [words[1] for words in map(bytes.split, lines) if words[:1] == [b"format"]]
    encoding = formats[0].decode() if formats else "missing"
    orders = {"binary_little_endian": "<", "binary_big_endian": ">"}
    if encoding not in orders:
        raise InvalidInput(
            f"the format is {encoding}; in chunks {' and '.join(orders)} can be read"
        )
    return orders[encoding]


def _row(vertices: Element, order: str) -> np.dtype:
    """What stands of each. Raises InvalidInput unless that is of one size, with x, y and z."""
    types = [TYPES.get(words[0].decode()) for words in vertices.properties]
    if None in types:
        raise InvalidInput("the vertices have a list, or a property of an unknown type")
    names = [words[-1].decode() for words in vertices.properties]
    if not {"x", "y", "z"} <= {*names}:
        raise InvalidInput("the vertices lack x, y or z")
    return np.dtype([(name, f"{order}{type}") for name, type in zip(names, types)])
