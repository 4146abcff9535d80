"""The clouds of the Point Cloud Library, by its definition: ascii, binary and binary_compressed."""

from __future__ import annotations

import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape
from .location import content_of

_NORMALS = ("normal_x", "normal_y", "normal_z")


def read(path: Path, reading: Reading) -> Shape:
    """x, y and z, and the normals where the file has them; organised clouds row by row, with their
    missing points as NaN."""
    header, body = _header(content_of(path))
    fields = _fields(header)
    count = _count(header)
    missing = [name for name in "xyz" if name not in fields.names]
    if missing:
        raise InvalidInput(f"it has no field {missing[0]}; there are {', '.join(fields.names)}")
    columns = _READERS[header["DATA"][0]](body, fields.type, count)

    def vectors(names: tuple[str, ...]) -> NDArray[np.float64]:
        return np.column_stack(
            [columns[f"{fields.names.index(name)}"][:, 0].astype(np.float64) for name in names]
        )

    has_normals = set(_NORMALS) <= set(fields.names)
    return Shape(vectors(("x", "y", "z")), normals=vectors(_NORMALS) if has_normals else None)


def _header(content: bytes) -> tuple[dict[str, list[str]], bytes]:
    """The words of each line by the first, and what stands behind the header."""
    header: dict[str, list[str]] = {}
    position = 0
    while "DATA" not in header:
        end = content.find(b"\n", position)
        if end < 0:
            raise InvalidInput("this is no PCD file: its header has no line DATA")
        key, *words = content[position:end].decode("ascii", "replace").split() or ["#"]
        header[key.upper()] = words
        position = end + 1
    if header["DATA"][:1] not in [[kind] for kind in _READERS]:
        raise InvalidInput(
            f"DATA is {' '.join(header['DATA'])!r:.40}; allowed are ascii, binary, binary_compressed"
        )
    return header, content[position:]


class _Fields:
    def __init__(self, names: list[str], type_: np.dtype[Any]) -> None:
        self.names, self.type = names, type_


def _fields(header: dict[str, list[str]]) -> _Fields:
    names = header.get("FIELDS") or header.get("COLUMNS") or []
    sizes, kinds = header.get("SIZE", []), header.get("TYPE", [])
    counts = header.get("COUNT") or ["1"] * len(names)
    if not names or not len(names) == len(sizes) == len(kinds) == len(counts):
        raise InvalidInput("the lines FIELDS, SIZE, TYPE and COUNT do not name as many fields")
    parts: list[Any] = []
    for number, (kind, size, count) in enumerate(zip(kinds, sizes, counts)):
        try:
            parts.append((f"{number}", np.dtype(f"<{kind.lower()}{size}"), (int(count),)))
        except (TypeError, ValueError) as error:
            raise InvalidInput(f"there is no type {kind} of {size} bytes") from error
    return _Fields(names, np.dtype(parts))


def _count(header: dict[str, list[str]]) -> int:
    if "POINTS" in header:
        return int(header["POINTS"][0])
    return int(header["WIDTH"][0]) * int(header.get("HEIGHT", ["1"])[0])


def _text(body: bytes, fields: np.dtype[Any], count: int) -> dict[str, NDArray[Any]]:
    sizes = [fields[name].shape[0] for name in fields.names or ()]
    needed = count * sum(sizes)
    if 2 * needed > len(body) + 1:  # with what stands between them
        raise _truncated(count, 2 * needed - 1, "bytes or more", len(body))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # of what is no number
            numbers = np.fromstring(body, np.float64, needed, sep=" ")
    except (ValueError, DeprecationWarning) as error:
        raise InvalidInput(
            f"the file is truncated, or holds what is no number: {count} points take {needed}"
        ) from error
    table = numbers.reshape(count, -1)
    ends = np.cumsum(sizes)
    return {f"{i}": table[:, end - size : end] for i, (size, end) in enumerate(zip(sizes, ends))}


def _binary(body: bytes, fields: np.dtype[Any], count: int) -> dict[str, NDArray[Any]]:
    if len(body) < count * fields.itemsize:
        raise _truncated(count, count * fields.itemsize, "bytes", len(body))
    rows = np.frombuffer(body, fields, count)
    return {name: rows[name] for name in fields.names or ()}


def _packed(body: bytes, fields: np.dtype[Any], count: int) -> dict[str, NDArray[Any]]:
    """Each field of all points, one behind the other."""
    if len(body) < 8:
        raise _truncated(count, 8, "bytes", len(body))
    packed, size = struct.unpack_from("<II", body)
    content = _unpacked(body[8 : 8 + packed], size)
    columns, start = {}, 0
    for name in fields.names or ():
        field = fields[name]
        if len(content) < start + field.itemsize * count:
            raise _truncated(count, count * fields.itemsize, "unpacked bytes", len(content))
        base, shape = field.subdtype or (field, (1,))
        columns[name] = np.frombuffer(content, base, count * shape[0], start).reshape(count, -1)
        start += field.itemsize * count
    return columns


_READERS = {"ascii": _text, "binary": _binary, "binary_compressed": _packed}
# As some versions of PCL write it.
_READERS["binaryscompressed"] = _packed


def _truncated(count: int, needed: int, what: str, there: int) -> InvalidInput:
    return InvalidInput(
        f"the file is truncated: {count} points take {needed} {what}, there are {there}"
    )


def _unpacked(packed: bytes, size: int) -> bytes:
    """By LZF: runs of bytes, and references to what was unpacked before."""
    made = bytearray()
    position = 0
    while position < len(packed) and len(made) < size:
        control = packed[position]
        position += 1
        if control < 32:
            made += packed[position : position + control + 1]
            position += control + 1
            continue
        length = (control >> 5) + 2
        if length == 9:
            length += packed[position]
            position += 1
        start = len(made) - ((control & 31) << 8) - packed[position] - 1
        position += 1
        if start < 0:
            raise InvalidInput("its packed data refer to what is not there")
        piece = made[start : start + length]
        if len(piece) < length:  # it repeats itself
            piece *= length // len(piece) + 1
        made += piece[:length]
    return bytes(made)
