"""What a method says about a case: images of its points, a mirror, or that there is none."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..reading import read
from ..reading.json_records import content_of, mirror_from

_IMAGES = (".ply", ".csv", ".xyz")
_RECORDS = (".summary.json", ".json")


class Answer(NamedTuple):
    images: NDArray[np.float64] | None
    """(n, 3), NaN where a point has no image; None: no mirror was given."""
    kind: str
    """Of the mirror: "plane", "cylinder", "sphere", any other word for a freer one, "" where it is
    not said, "none" where there is none."""
    found: bool
    """Whether the method says that the shape has a mirror."""


def answer_in(folder: Path, name: str, points: NDArray[np.float64]) -> Answer | None:
    """The answer of the files NAME.ply, .csv or .xyz, NAME.json or NAME.summary.json in the folder;
    None where there is none of them.

    A JSON holds "mirror", a record as symsurf writes it or null, and may hold "kind" and
    "verdict", "found" or "none". Raises InvalidInput, naming the file, for a broken one and for
    other than one image per point.
    """
    images = next((p for s in _IMAGES if (p := folder / f"{name}{s}").exists()), None)
    record = next((p for s in _RECORDS if (p := folder / f"{name}{s}").exists()), None)
    if record is None:
        return None if images is None else Answer(_images(images, points), "", True)
    with content_of(record, "no answer") as said:
        verdict = said.get("verdict") or said.get("statistics", {}).get("verdict", "found")
        kind = str(said.get("kind") or (said.get("mirror") or {}).get("kind", ""))
        given = None if images else _over_mirror(said.get("mirror"), points)
    if images:
        given = _images(images, points)
    found = verdict == "found" and given is not None
    return Answer(given, kind if given is not None else "none", found)


def _over_mirror(
    record: dict[str, Any] | None, points: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    return None if record is None else mirror_from(record).reflect(points)


def _images(path: Path, points: NDArray[np.float64]) -> NDArray[np.float64]:
    images = read(path).points
    if len(images) != len(points):
        raise InvalidInput(f"{path} has {len(images)} images; the case has {len(points)} points")
    return images
