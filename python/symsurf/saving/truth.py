"""The truth of a generated sample in a file beside it: its mirror and its pairs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, Mirror, make_mirror
from ..reading.json_records import content_of, mirror_from, pairs_from
from ..results.base_result import mirror_record
from .points_format import write_points
from .whole_files import write_whole


class Truth(NamedTuple):
    mirror: Mirror
    pairs: NDArray[np.int64]
    """(m, 2): the row of a point, the row of its image."""

    def moved(self, rotation: NDArray[np.float64]) -> Truth:
        """The truth of the points turned about the origin."""
        return self._replace(mirror=_rotated(self.mirror, rotation))

    def kept(self, rows: NDArray[np.int64], count: int) -> Truth:
        """The truth of some rows of ``count`` points: the pairs that are still whole.

        Raises InvalidInput for pairs of other rows than those of the points.
        """
        others = self.pairs[(self.pairs < 0) | (self.pairs >= count)]
        if others.size:
            raise InvalidInput(
                f"the truth pairs point {others[0]}; the sample has the points 0 to {count - 1}"
            )
        renamed = np.full(count, -1)
        renamed[rows] = np.arange(len(rows))
        pairs = renamed[self.pairs]
        return self._replace(pairs=pairs[(pairs >= 0).all(axis=1)])


def truth_path(points: Path) -> Path:
    """Where the truth of a file of points is kept: "a.xyz" has "a.xyz.truth.json"."""
    return points.with_name(f"{points.name}.truth.json")


def write_sample(path: Path, points: NDArray[np.float64], truth: Truth | None) -> None:
    """The points, and their truth beside them; a truth of what stood there before goes."""
    write_points(path, points)
    truth_path(path).unlink(missing_ok=True)
    if truth is not None:
        record = {"mirror": mirror_record(truth.mirror), "pairs": truth.pairs.tolist()}
        write_whole(truth_path(path), (json.dumps(record) + "\n").encode())


def read_truth(path: Path) -> Truth:
    """Raises InvalidInput, naming the file, for one that is missing or broken."""
    with content_of(path, "not the truth of a sample") as record:
        return Truth(mirror_from(record["mirror"]), pairs_from(record["pairs"]))


def _rotated(mirror: Mirror, rotation: NDArray[np.float64]) -> Mirror:
    numbers = dict(mirror.numbers)
    if mirror.kind == "sphere":
        numbers["centre"] = rotation @ numbers["centre"]
    elif mirror.kind == "surface":
        numbers["rotation"] = rotation @ numbers["rotation"]
        numbers["translation"] = rotation @ numbers["translation"]
    else:
        raise InvalidInput(f"a truth of the kind {mirror.kind} cannot be turned")
    return make_mirror(mirror.kind, numbers)
