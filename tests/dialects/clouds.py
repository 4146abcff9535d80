"""Scans: LAS and LAZ, and PCD."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import POINTS

_SIZES = {0: 20, 1: 28, 2: 26, 3: 34, 6: 30, 7: 36, 8: 38}  # bytes of a point by its format
_HEADERS = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}


def las(
    minor: int = 2,
    kind: int = 0,
    scale: float = 0.25,
    offset: Sequence[float] = (0, 0, 0),
    more: int = 0,
    before: bytes = b"",
    behind: bytes = b"",
    count: int | None = None,
    records: int | None = None,
    legacy: bool = True,
) -> bytes:
    count = len(POINTS) if count is None else count
    size, head = _SIZES[kind & 63] + more, _HEADERS[minor]
    start = head + len(before)
    records = (1 if before else 0) if records is None else records
    short = count if legacy and count < 2**32 else 0
    header = b"LASF" + bytes(20) + bytes([1, minor]) + b"made".ljust(64, b"\0") + bytes(4)
    header += struct.pack("<HIIBHI5I", head, start, records, kind, size, short, *[short] * 5)
    header += struct.pack("<6d", *[scale] * 3, *offset) + struct.pack("<6d", *[0] * 6)
    if minor >= 4:
        header = header.ljust(235, b"\0") + struct.pack("<QIQ", 0, 0, count)
    numbers = np.round((POINTS - offset) / scale).astype("<i4")
    body = b"".join(row.tobytes().ljust(size, b"\1") for row in numbers)
    return header.ljust(head, b"\0") + before + body + behind


def _by_laspy(version: str, kind: int, suffix: str) -> tuple[str, Any]:
    def write(path: Path) -> None:
        import laspy

        header = laspy.LasHeader(version=version, point_format=kind)
        header.scales, header.offsets = [0.25] * 3, [1000, -2000, 0]
        scan = laspy.LasData(header)
        scan.xyz = POINTS
        scan.write(path)

    return suffix, write


_VLR = bytes(18) + struct.pack("<HH", 7, 10) + bytes(32) + bytes(10)
LAS: dict[str, Any] = {
    **{f"1.{minor}": las(minor) for minor in _HEADERS},
    **{f"format {kind}": las(4 if kind > 5 else 2, kind) for kind in _SIZES},
    "far away": las(offset=(4e6, -5e5, 100)),
    "another scale": las(scale=0.0625),
    "a record before the points": las(before=_VLR),
    "bytes before the points": las(before=b"\xcc\xdd", records=0),
    "more bytes a point": las(more=3),
    "more behind": las(4, behind=bytes(60)),
    "the long count alone": las(4, 6, legacy=False),
    "laspy, 1.2": _by_laspy("1.2", 3, ".las"),
    "laspy, 1.4": _by_laspy("1.4", 6, ".las"),
    "packed": _by_laspy("1.2", 3, ".laz"),
    "packed, 1.4": _by_laspy("1.4", 7, ".laz"),
    "LAS that is called LAZ": (".laz", las()),
}
REFUSED_LAS = {
    las(count=4_000_000_000): "4000000000 points take",
    las(4, 6, count=9 * 10**18, legacy=False): "truncated",
    las(records=4_000_000_000): "promises 4000000000 records",
    las(kind=0x80): "its points are packed",
    las()[:200]: "header is truncated",
    b"LASF" + b"\2" * 300: "version is 2.2",
    b"\0" * 300: "does not start with 'LASF'",
}


def pcd(
    data: str = "ascii",
    real: tuple[str, int] = ("F", 4),
    extra: Sequence[tuple[str, str, int, int]] = (),
    order: str = "xyz",
    joint: str = " ",
    drop: Sequence[str] = (),
    change: Sequence[tuple[str, str]] = (),
    height: int = 1,
    end: str = "\n",
) -> bytes:
    """Extra fields are given by name, type, size and count."""
    fields = [(axis, *real, 1) for axis in order] + list(extra)
    lines = ["# .PCD v0.7 - Point Cloud Data file format", "VERSION 0.7"]
    for key, column in (("FIELDS", 0), ("SIZE", 2), ("TYPE", 1), ("COUNT", 3)):
        lines.append(f"{key} {' '.join(str(field[column]) for field in fields)}")
    lines += [f"WIDTH {len(POINTS) // height}", f"HEIGHT {height}", "VIEWPOINT 0 0 0 1 0 0 0"]
    lines += [f"POINTS {len(POINTS)}", f"DATA {data}"]
    head = end.join([line for line in lines if line.split()[0] not in drop] + [""])
    for old, new in change:
        head = head.replace(old, new)
    dtype = np.dtype([(f"f{i}", f"<{f[1].lower()}{f[2]}", (f[3],)) for i, f in enumerate(fields)])
    rows = np.ones(len(POINTS), dtype)
    for i, field in enumerate(fields):
        if field[0] in "xyz":
            rows[f"f{i}"][:, 0] = POINTS[:, "xyz".index(field[0])]
    if data == "ascii":
        lines = [
            joint.join(f"{value:g}" for name in dtype.names or () for value in row[name])
            for row in rows
        ]
        return (head + end.join([*lines, ""])).encode()
    if data == "binary":
        return head.encode() + rows.tobytes()
    columns = b"".join(rows[name].tobytes() for name in dtype.names or ())
    packed = _literal(columns)
    return head.encode() + struct.pack("<II", len(packed), len(columns)) + packed


def _literal(content: bytes) -> bytes:
    """LZF's runs, with a reference in place of eight equal bytes at the end of a run."""
    made = b""
    position = 0
    while position < len(content):
        run = content[position : position + 24]
        made += bytes([len(run) - 1]) + run
        position += len(run)
        if (
            len(run) > 7
            and len(set(run[-8:])) == 1
            and content[position : position + 8] == run[-8:]
        ):
            made += bytes([(6 << 5), 0])  # eight bytes, each the one before
            position += 8
    return made


_RGB = ("rgb", "F", 4, 1)
_NORMALS = [(f"normal_{axis}", "F", 4, 1) for axis in "xyz"]
_HISTOGRAM = ("fpfh", "F", 4, 33)
PCD: dict[str, Any] = {
    "text": pcd(),
    "binary": pcd("binary"),
    "packed": pcd("binary_compressed"),
    "doubles": pcd("binary", ("F", 8)),
    "packed doubles": pcd("binary_compressed", ("F", 8)),
    "aligned columns": pcd(joint="   "),
    "tabs": pcd(joint="\t"),
    "of Windows": pcd(end="\r\n"),
    "colours": pcd(extra=[_RGB]),
    "colours in binary": pcd("binary", extra=[_RGB]),
    "normals": pcd(extra=_NORMALS),
    "normals in binary": pcd("binary", extra=_NORMALS),
    "packed normals": pcd("binary_compressed", extra=_NORMALS),
    "a histogram": pcd(extra=[_HISTOGRAM]),
    "a histogram in binary": pcd("binary", extra=[_HISTOGRAM]),
    "padding": pcd("binary", extra=[("_", "U", 1, 4), ("ring", "U", 2, 1), ("_", "U", 1, 10)]),
    "another order": pcd(order="zxy"),
    "another order in binary": pcd("binary", order="yzx"),
    "organised": pcd("binary", height=2),
    "no counts": pcd(drop=["COUNT"]),
    "no number of points": pcd(drop=["POINTS"]),
    "no view": pcd("binary", drop=["VIEWPOINT", "VERSION"]),
    "version .5": pcd(change=[("FIELDS", "COLUMNS"), ("VERSION 0.7", "VERSION .5")]),
    "blank lines": pcd(change=[("VERSION", "\n# by hand\nVERSION")]),
}
REFUSED_PCD = {
    pcd(change=[("POINTS 6", "POINTS 9000000000")]): "9000000000 points take",
    pcd("binary", change=[("POINTS 6", "POINTS 9000000000")]): "truncated",
    pcd("binary_compressed", change=[("POINTS 6", "POINTS 9000000000")]): "truncated",
    pcd(change=[("DATA ascii", "DATA zipped")]): "DATA is 'zipped'",
    pcd(change=[("FIELDS x y z", "FIELDS u v w")]): "no field x; there are u, v, w",
    pcd(change=[("TYPE F F F", "TYPE F F Q")]): "no type Q of 4 bytes",
    pcd(change=[("SIZE 4 4 4", "SIZE 4 4")]): "do not name as many fields",
    b"VERSION 0.7\n": "no line DATA",
}
