"""NRRD masks and images, by pynrrd."""

from __future__ import annotations

import bz2
import gzip
import re
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, BinaryIO

import nrrd
import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..shapes import Choice, Shape, chosen_by
from .location import copy_bounded
from .voxels import world_points

_SPACES = {
    **dict.fromkeys(("left-posterior-superior", "lps"), "LPS"),
    **dict.fromkeys(("right-anterior-superior", "ras"), "RAS"),
}
_SEGMENT = re.compile(r"Segment(\d+)_(\w+)")
_PACKED: dict[str, Any] = {
    **dict.fromkeys(("gzip", "gz"), gzip.open),
    **dict.fromkeys(("bzip2", "bz2"), bz2.open),
}


def read(path: Path, choice: Choice) -> Shape:
    """The centres of the voxels that are chosen, in the space that the header names: LPS where 3D
    Slicer wrote it. Of a segmentation in layers, those of any segment or of the one chosen."""
    values, header = _values_and_header(path)
    affine = np.eye(4)
    directions = np.array(header.get("space directions", []), dtype=float)
    if values.ndim == 4 and header.get("kinds", [""])[0] == "list":
        values, choice = _segments(values, header, choice), Choice()
        directions = directions[1:]
    elif isinstance(choice.label, str):
        choice = Choice(label=int(_segment(header, choice.label)["LabelValue"]))
    spacings = header.get("spacings")
    if directions.shape == (3, 3):
        affine[:3, :3] = directions.T
    elif spacings is not None and np.shape(spacings) == (3,):
        affine[:3, :3] = np.diag(np.where(np.isnan(spacings), 1, spacings))
    origin = header.get("space origin")
    if origin is not None and np.shape(origin) == (3,):
        affine[:3, 3] = origin
    return world_points(values, affine, choice, _SPACES.get(header.get("space", "").lower()))


def _segments(layers: NDArray[Any], header: dict[str, Any], choice: Choice) -> NDArray[np.bool_]:
    """Whether each voxel (i, j, k) of layers (layer, i, j, k) is chosen."""
    if isinstance(choice.label, str):
        segment = _segment(header, choice.label)
        return layers[int(segment.get("Layer", 0))] == int(segment["LabelValue"])
    if not choice.given():
        return np.logical_or.reduce(layers != 0)
    return np.logical_or.reduce(chosen_by(layers, choice, "image"))


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
