"""Laser scans: LAS by its definition, version 1.0 to 1.4."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape

_HEADER = 227  # bytes of the shortest one
_COUNT = 247  # where version 1.4 has the number of points, behind that of extended records
_PACKED = 0xC0  # the bits of a point format that mark LAZ
_PROJECTION = b"LASF_Projection"  # the user of records about the coordinates' system
_SYSTEMS = (2112, 34735, 34736, 34737)  # WKT, and GeoTIFF's keys, numbers and texts
_RECORD = 54  # bytes of the header of a variable length record


def read(path: Path, reading: Reading) -> Shape:
    """All points, with the file's scale and offset applied."""
    content = np.memmap(path, np.uint8, "r")
    start, length, count, is_packed = layout(path)
    if is_packed:
        raise InvalidInput("its points are packed; with input_format laz they can be read")
    return Shape(coordinates(path, content[start : start + count * length].reshape(count, length)))


def coordinates(path: Path, rows: NDArray[np.uint8]) -> NDArray[np.float64]:
    """(n, 3) of rows of bytes, a point each."""
    header = np.fromfile(path, np.uint8, _HEADER)
    scales, offsets = np.frombuffer(header[131:179].tobytes(), "<f8").reshape(2, 3)
    return np.ascontiguousarray(rows[:, :12]).view("<i4") * scales + offsets


def reference_system(path: Path) -> bytes:
    """What the variable length records say of the coordinates' system, GeoTIFF's keys or WKT; empty
    where they say nothing."""
    with path.open("rb") as file:
        header = file.read(_HEADER)
        length, records = (
            struct.unpack_from("<H", header, 94)[0],
            struct.unpack_from("<I", header, 100)[0],
        )
        file.seek(length)
        found = []
        for _ in range(records):
            user, number, size = struct.unpack("<2x16sHH32x", file.read(_RECORD))
            content = file.read(size)
            if user.rstrip(b"\0") == _PROJECTION and number in _SYSTEMS:
                found.append(content)
    return b"".join(found)


def layout(path: Path) -> tuple[int, int, int, bool]:
    """Where the points start, the bytes of one, how many there are, and whether they are packed.

    Raises InvalidInput where the file holds less than the header promises.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        header = file.read(_COUNT + 8)
    if not header.startswith(b"LASF"):
        raise InvalidInput("this is no LAS file: it does not start with 'LASF'")
    if len(header) < _HEADER:
        raise InvalidInput(f"the header is truncated: it has {len(header)} bytes of {_HEADER}")
    major, minor = header[24:26]
    if major != 1:
        raise InvalidInput(f"LAS's version is {major}.{minor}; 1.0 to 1.4 can be read")
    extended = 0
    start, records, kind, length, count = struct.unpack_from("<IIBHI", header, 96)
    if minor >= 4 and len(header) == _COUNT + 8:
        extended, long_count = struct.unpack_from("<IQ", header, _COUNT - 4)
        count = long_count or count
    if length < 12:
        raise InvalidInput(f"a point has {length} bytes; x, y and z take 12")
    if start > size or (records + extended) * _RECORD > size:
        raise InvalidInput(
            f"the file is truncated: it promises {records + extended} records beside the points from "
            f"byte {start} on, and has {size} bytes"
        )
    is_packed = bool(kind & _PACKED)
    if not is_packed and start + count * length > size:
        raise InvalidInput(
            f"the file is truncated: {count} points take {start + count * length} bytes, it has {size}"
        )
    return start, length, count, is_packed
