"""Reading landmarks, each format in its own module of ``landmark_formats``."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from .._core import InvalidInput
from ..shapes import Landmarks
from .errors import broken, naming
from .formats import PACKED, suffix_of
from .landmark_formats import markups, pts, table, tps
from .location import located

LANDMARK_FORMATS: dict[str, Callable[[Path], list[Landmarks]]] = {
    ".json": markups.read,
    ".fcsv": table.read_fcsv,
    ".tps": tps.read,
    ".pts": pts.read,
    ".csv": table.read_csv,
}
_KNOWN = "none of .mrk.json .fcsv .tps .pts .csv, each also as .gz"


def read_landmarks(path: str | os.PathLike[str]) -> Landmarks:
    """Reads the landmarks of one specimen.

    3D Slicer's ``.mrk.json`` and ``.fcsv``, TPS (``LM=`` and ``LM3=``, times ``SCALE=``, without
    curves), PTS (of Landmark with names and the 9999 of missing ones, and plain rows) and CSV (names
    and coordinates, with a row that names the columns or without); each also packed, as ``.tps.gz``.
    Coordinates stay in the unit and the axes of the file.

    Args:
        path: the name of a file; its suffix tells the format.

    Raises:
        InvalidInput: names the file and the reason: an unknown suffix, not readable, broken,
            truncated, no landmarks, or several specimens, which ``read_landmark_sets`` reads.
    """
    sets = read_landmark_sets(path)
    if len(sets) > 1:
        raise InvalidInput(
            f"{os.fspath(path)}: there are {len(sets)} specimens; allowed is one, and "
            "symsurf.read_landmark_sets reads them all"
        )
    return sets[0]


def read_landmark_sets(path: str | os.PathLike[str]) -> list[Landmarks]:
    """Reads the landmarks of every specimen in a file, in its order: TPS and ``.mrk.json`` may hold
    several. Arguments and errors are those of ``read_landmarks``."""
    if not isinstance(path, (str, os.PathLike)):
        raise InvalidInput(f"path is {path!r}; allowed is the name of a file")
    name = os.fsdecode(path)
    suffix = suffix_of(Path(name))
    reader = LANDMARK_FORMATS.get(suffix.removesuffix(PACKED))
    if reader is None:
        raise InvalidInput(f"{name}: suffix '{suffix}' is {_KNOWN}")
    with naming(name), broken(suffix.removesuffix(PACKED)[1:].upper()):
        with located(name, suffix, None) as file:
            sets = reader(file)
        if not sets or not all(len(each.points) for each in sets):
            raise InvalidInput("there are no landmarks")
    return sets


def is_landmark_file(path: Path) -> bool:
    """Whether the suffix is one of landmarks."""
    return suffix_of(path).removesuffix(PACKED) in LANDMARK_FORMATS
