"""Masks: NRRD and NIfTI."""

from __future__ import annotations

import bz2
import gzip
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

MASK = np.zeros((5, 6, 4), np.uint8)
MASK[1:3, 2:5, 1:3] = 1
MASK[4, 5, 3] = 1
AFFINE = np.array([[0, -2, 0, 10], [1.5, 0, 0, -20], [0, 0.5, 3, 30], [0, 0, 0, 1]])
CHOSEN = np.argwhere(MASK) @ AFFINE[:3, :3].T + AFFINE[:3, 3]


def _vector(values: Any) -> str:
    return "(" + ",".join(f"{value:g}" for value in values) + ")"


def nrrd(
    values: Any = MASK,
    encoding: str = "raw",
    kind: str = "uint8",
    version: int = 4,
    space: str = "space: left-posterior-superior",
    axes: str = "domain domain domain",
    more: str = "",
    end: str = "\n",
    order: str = "little",
    comments: str = "",
) -> bytes:
    """Values are (i, j, k), or (layer, i, j, k)."""
    array = np.asarray(values)
    lines = [f"NRRD000{version}", *filter(None, [comments]), f"type: {kind}"]
    lines += [f"dimension: {array.ndim}", space, f"sizes: {' '.join(map(str, array.shape))}"]
    directions = [_vector(column) for column in AFFINE[:3, :3].T]
    none = ["none"] if array.ndim == 4 else []
    lines += [f"space directions: {' '.join(none + directions)}", f"kinds: {axes}"]
    lines += [f"endian: {order}", f"encoding: {encoding}"]
    lines += [f"space origin: {_vector(AFFINE[:3, 3])}", *filter(None, [more]), "", ""]
    raw = array.astype(array.dtype.newbyteorder("<" if order == "little" else ">")).tobytes("F")
    packed = {
        "raw": raw,
        "gzip": gzip.compress(raw),
        "gz": gzip.compress(raw),
        "bzip2": bz2.compress(raw),
        "ascii": " ".join(map(str, array.ravel("F").tolist())).encode(),
        "hex": raw.hex().encode(),
    }
    return end.join(lines).encode() + packed[encoding]


def _detached(path: Path) -> None:
    content = nrrd()
    head, _, raw = content.partition(b"\n\n")
    path.with_name("shape.raw").write_bytes(raw)
    path.write_bytes(head + b"\ndata file: shape.raw\n")


_TWO = np.zeros((2, *MASK.shape), np.uint8)
_TWO[0, 1:3, 2:4, 1:3] = 1  # two segments of the label 1 in layers of their own, which overlap
_TWO[1, 1:3, 3:5, 1:3] = 1
_TWO[1, 4, 5, 3] = 2
_SEGMENTS = "\n".join(
    f"Segment{i}_Name:={name}\nSegment{i}_LabelValue:={label}\nSegment{i}_Layer:={layer}"
    for i, (name, label, layer) in enumerate([("left", 1, 0), ("right", 1, 1), ("tip", 2, 1)])
)
LAYERED = nrrd(_TWO, axes="list domain domain domain", more=_SEGMENTS)
NRRD: dict[str, Any] = {
    "raw": nrrd(),
    "gzip": nrrd(encoding="gzip"),
    "gz": nrrd(encoding="gz"),
    "bzip2": nrrd(encoding="bzip2"),
    "text": nrrd(encoding="ascii"),
    "of Windows": nrrd(end="\r\n"),
    "version 5": nrrd(version=5),
    "comments": nrrd(
        comments="# Complete NRRD file format specification at:\n# http://teem.sf.net"
    ),
    "keys and values": nrrd(more="maker:=by hand"),
    "a small name of the space": nrrd(space="space: LPS"),
    "RAS": nrrd(space="space: right-anterior-superior"),
    "no name of the space": nrrd(space="space dimension: 3"),
    "signed": nrrd(MASK.astype(np.int8), kind="signed char"),
    "short": nrrd(MASK.astype(np.int16), kind="short"),
    "unsigned short": nrrd(MASK.astype(np.uint16), kind="unsigned short", encoding="gzip"),
    "big": nrrd(MASK.astype(np.int16), kind="int16", order="big"),
    "long": nrrd(MASK.astype(np.int32), kind="int"),
    "real": nrrd(MASK.astype(np.float32), kind="float"),
    "double": nrrd(255 * MASK.astype(np.float64), kind="double", encoding="gzip"),
    "space kinds": nrrd(axes="space space space"),
    "layers of segments": LAYERED,
    "beside": _detached,
    "255": nrrd(255 * MASK),
}


def nifti(
    kind: Any = np.uint8,
    form: str = "sform",
    order: str = "<",
    axes: int = 3,
    magic: bytes = b"n+1\0",
    extended: int = 0,
    slope: float = 0.0,
    version: int = 1,
) -> bytes:
    """A file by its definition, byte by byte."""
    values = MASK.astype(kind)
    codes = {"uint8": 2, "int16": 4, "int32": 8, "float32": 16, "float64": 64, "int8": 256}
    codes |= {"uint16": 512, "uint32": 768, "int64": 1024}
    size = [axes, *MASK.shape, *[1] * 4][:8]
    bits = values.dtype.itemsize * 8
    code = codes[values.dtype.name]
    rows = AFFINE[:3].ravel()
    if version == 2:
        head = struct.pack(order + "i8s2h", 540, b"n+2\0\r\n\x1a\n", code, bits)
        head += struct.pack(order + "8q3d8d", *size, 0, 0, 0, *[1.0] * 8)
        head += struct.pack(order + "q2d", 544 + extended, slope, 0)
        head = head.ljust(344, b"\0") + struct.pack(order + "2i", 0, 2)
        head = head.ljust(400, b"\0") + struct.pack(order + "12d", *rows)
        head = head.ljust(540, b"\0")
        start = 544 + extended
    else:
        head = struct.pack(order + "i", 348).ljust(40, b"\0") + struct.pack(order + "8h", *size)
        head = head.ljust(70, b"\0") + struct.pack(order + "2h", code, bits)
        head = head.ljust(76, b"\0") + struct.pack(order + "8f", 1, *_spacings(form), 1, 1, 1, 1)
        head += struct.pack(order + "3f", 352 + extended, slope, 0)
        sform, qform = (2, 0) if form == "sform" else (0, 1)
        head = head.ljust(252, b"\0") + struct.pack(order + "2h", qform, sform)
        head += struct.pack(order + "6f", 0, 0, 0, *AFFINE[:3, 3])
        head = head.ljust(280, b"\0") + struct.pack(order + "12f", *rows)
        head = head.ljust(344, b"\0") + magic
        start = 352 + extended
    head += bytes([1 if extended else 0, 0, 0, 0])
    head += struct.pack(order + "2i", extended, 6).ljust(extended, b"\0") if extended else b""
    assert len(head) == start
    return head + values.astype(values.dtype.newbyteorder(order)).tobytes("F")


def _lying(sides: Sequence[int]) -> bytes:
    content = bytearray(nifti(slope=0.5))
    struct.pack_into("<4h", content, 40, 3, *sides)
    return bytes(content)


def _spacings(form: str) -> list[float]:
    return [1.5, 2.0, 3.0] if form == "sform" else [1.0, 1.0, 1.0]


def _by_nibabel(suffix: str, make: Any) -> tuple[str, Any]:
    def write(path: Path) -> None:
        import nibabel

        make(nibabel).to_filename(path)

    return suffix, write


REFUSED_NIFTI = {
    _lying((1500, 1500, 1500)): "truncated: its values end at byte 3375000352",
    _lying((32000, 32000, 32000)): "truncated",
}
REFUSED_NRRD = {
    nrrd(encoding=encoding).replace(b"sizes: 5 6 4", b"sizes: 90000 90000 90000"): "729000000000000"
    for encoding in ("raw", "gzip", "ascii")
}
_KINDS = (np.int8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.float32, np.float64)
NIFTI: dict[str, Any] = {
    "plain": nifti(),
    "big": nifti(order=">"),
    "big shorts": nifti(np.int16, order=">"),
    "second version": nifti(version=2),
    "second version, big": nifti(np.int16, version=2, order=">"),
    "packed": (".nii.gz", gzip.compress(nifti())),
    "packed, second version": (".nii.gz", gzip.compress(nifti(version=2))),
    "four axes": nifti(axes=4),
    "five axes": nifti(axes=5),
    "an extension": nifti(extended=32),
    "a slope of 1": nifti(np.int16, slope=1.0),
    "a slope": nifti(np.int16, slope=0.5),
    **{np.dtype(kind).name: nifti(kind) for kind in _KINDS},
    "nibabel": _by_nibabel(".nii", lambda nib: nib.Nifti1Image(MASK, AFFINE)),
    "nibabel, packed": _by_nibabel(".nii.gz", lambda nib: nib.Nifti1Image(MASK, AFFINE)),
    "nibabel, second version": _by_nibabel(".nii", lambda nib: nib.Nifti2Image(MASK, AFFINE)),
}
