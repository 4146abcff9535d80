"""NRRD masks and images, by pynrrd."""

from __future__ import annotations

import bz2
import gzip
import re
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any, BinaryIO

import nrrd
import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape, chosen_by
from .location import copy_bounded, referenced
from .voxels import world_points

_SPACES = {
    **dict.fromkeys(("left-posterior-superior", "lps"), "LPS"),
    **dict.fromkeys(("right-anterior-superior", "ras"), "RAS"),
}
_SEGMENT = re.compile(r"Segment(\d+)_(\w+)")
_ELSEWHERE = ("data file", "datafile")  # what names the file with the values
_PACKED: dict[str, Any] = {
    **dict.fromkeys(("gzip", "gz"), gzip.open),
    **dict.fromkeys(("bzip2", "bz2"), bz2.open),
}


def read(path: Path, reading: Reading) -> Shape:
    """The centres of the voxels that are chosen, in the space that the header names: LPS where 3D
    Slicer wrote it. Of a segmentation in layers, those of any segment or of the one chosen."""
    values, header = _values_and_header(path, reading)
    affine = np.eye(4)
    directions = np.array(header.get("space directions", []), dtype=float)
    if values.ndim == 4 and header.get("kinds", [""])[0] == "list":
        values, reading = _segments(values, header, reading), Reading()
        directions = directions[1:]
    elif isinstance(reading.label, str):
        reading = Reading(label=int(_segment(header, reading.label)["LabelValue"]))
    spacings = header.get("spacings")
    if directions.shape == (3, 3):
        affine[:3, :3] = directions.T
    elif spacings is not None and np.shape(spacings) == (3,):
        affine[:3, :3] = np.diag(np.where(np.isnan(spacings), 1, spacings))
    origin = header.get("space origin")
    if origin is not None and np.shape(origin) == (3,):
        affine[:3, 3] = origin
    return world_points(values, affine, reading, _SPACES.get(header.get("space", "").lower()))


def _segments(layers: NDArray[Any], header: dict[str, Any], reading: Reading) -> NDArray[np.bool_]:
    """Whether each voxel (i, j, k) of layers (layer, i, j, k) is chosen."""
    if isinstance(reading.label, str):
        segment = _segment(header, reading.label)
        return layers[int(segment.get("Layer", 0))] == int(segment["LabelValue"])
    if not reading.of_image():
        return np.logical_or.reduce(layers != 0)
    return np.logical_or.reduce(chosen_by(layers, reading, "image"))


def _segment(header: dict[str, Any], name: str) -> dict[str, str]:
    """What 3D Slicer says of the segment of this name. Raises InvalidInput."""
    segments: dict[str, dict[str, str]] = {}
    for key, value in header.items():
        if match := _SEGMENT.fullmatch(key):
            segments.setdefault(match[1], {})[match[2]] = value
    for segment in segments.values():
        if name == segment.get("Name") and "LabelValue" in segment:
            return segment
    there_are = ", ".join(repr(each.get("Name")) for each in segments.values()) or "none"
    raise InvalidInput(f"no segment is called {name!r}; there are {there_are}")


def _values_and_header(path: Path, reading: Reading) -> tuple[NDArray[Any], dict[str, Any]]:
    with path.open("rb") as file:
        header = nrrd.read_header(file)
        own = {name: value for name, value in header.items() if name not in _ELSEWHERE}
        others = [header[name] for name in _ELSEWHERE if name in header]
        if not others:
            return _values(file, own), header
        with referenced(others[0], path, reading).open("rb") as data:
            return _values(data, own), header


def _values(file: BinaryIO, header: dict[str, Any]) -> NDArray[Any]:
    """Those that follow. What is packed pynrrd would unpack whole, however much that is."""
    if header.get("encoding") not in _PACKED:
        return nrrd.read_data(header, file)
    header = dict(header)
    for _ in range(header.pop("line skip", header.pop("lineskip", 0))):
        file.readline()
    # Without a name, so that it is gone whatever becomes of this process.
    with TemporaryFile(prefix="symsurf-") as raw, _PACKED[header["encoding"]](file) as content:
        copy_bounded(content, raw)
        raw.seek(0)
        return nrrd.read_data(header | {"encoding": "raw"}, raw)
