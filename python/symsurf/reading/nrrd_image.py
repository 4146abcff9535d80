"""NRRD masks and images, by pynrrd."""

from __future__ import annotations

import bz2
import gzip
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, BinaryIO

import nrrd
import numpy as np
from numpy.typing import NDArray

from ..shape import Shape
from .location import copy_bounded
from .voxels import world_points

_PACKED: dict[str, Any] = {
    **dict.fromkeys(("gzip", "gz"), gzip.open),
    **dict.fromkeys(("bzip2", "bz2"), bz2.open),
}


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    """The centres of the voxels that the threshold chooses, in the space that the header names:
    LPS where 3D Slicer wrote it."""
    values, header = _values_and_header(path)
    affine = np.eye(4)
    directions = header.get("space directions")
    spacings = header.get("spacings")
    if directions is not None and np.shape(directions) == (3, 3):
        affine[:3, :3] = np.asarray(directions, dtype=float).T
    elif spacings is not None and np.shape(spacings) == (3,):
        affine[:3, :3] = np.diag(np.where(np.isnan(spacings), 1, spacings))
    origin = header.get("space origin")
    if origin is not None and np.shape(origin) == (3,):
        affine[:3, 3] = origin
    return world_points(values, affine, threshold, scalars)


def _values_and_header(path: Path) -> tuple[NDArray[Any], dict[str, Any]]:
    with path.open("rb") as file:
        header = nrrd.read_header(file)
        if header.get("encoding") not in _PACKED:
            return nrrd.read_data(header, file, str(path)), header
        plain = dict(header)
        other = plain.pop("data file", plain.pop("datafile", None))
        lines = plain.pop("line skip", plain.pop("lineskip", 0))
        if other is None:
            return _unpacked(file, plain, lines), header
        with (path.parent / other).open("rb") as data:
            return _unpacked(data, plain, lines), header


def _unpacked(file: BinaryIO, header: dict[str, Any], lines: int) -> NDArray[Any]:
    """The values behind so many lines. pynrrd would unpack them whole, however many there are."""
    for _ in range(lines):
        file.readline()
    with TemporaryDirectory(prefix="symsurf-") as folder:
        raw = Path(folder) / "values"
        with _PACKED[header["encoding"]](file) as content:
            copy_bounded(content, raw)
        with raw.open("rb") as values:
            return nrrd.read_data(header | {"encoding": "raw"}, values)
