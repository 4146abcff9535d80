"""The files of a cohort as configurations of one order, and which of their landmarks are pairs."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, InvalidParameter
from ..detection import detect
from ..mirror_operations.operate import operate
from ..reading import read, stem_of
from ..reading.errors import broken, naming
from ..reading.landmarks import is_landmark_file, read_landmark_sets
from ..reading.location import text_of
from ..results import Correspondences, found_mirror
from ..shapes import Landmarks, Shape
from .checks import listed
from .pairing import LandmarkPairs, landmark_pairs, side_of
from .procrustes import superimposed


@dataclass(frozen=True, eq=False)
class Specimens:
    """Configurations with the same landmarks in the same order."""

    labels: list[str]
    """(n,) what each is called."""
    points: NDArray[np.float64]
    """(n, k, d)."""
    names: tuple[str, ...] = ()
    """(k,) of landmarks; none where the files name none."""
    faces: NDArray[np.int64] | None = None
    """(m, 3) of meshes."""


def read_specimens(files: Sequence[Path]) -> Specimens:
    """Those of files of landmarks, in the order of the first's names, or of meshes of one topology.

    Raises InvalidInput, naming the file: whatever ``read_landmarks`` and ``read`` raise; landmarks
    that one or the others do not have; other faces; two that are the same to the last digit.
    """
    given = [each for file in files for each in _read(file)]
    first = given[0]
    points = [_in_order(each, first) for each in given]
    _require_distinct(given, points)
    names = first.shape.names if isinstance(first.shape, Landmarks) else ()
    faces = first.shape.faces if isinstance(first.shape, Shape) else None
    return Specimens([each.label for each in given], np.array(points), names, faces)


def _require_distinct(given: Sequence[_Read], points: Sequence[NDArray[np.float64]]) -> None:
    known: dict[bytes, str] = {}
    for each, own in zip(given, points, strict=True):
        content = own.tobytes()
        if content in known:
            raise InvalidInput(
                f"{each.where}: its points are those of {known[content]}, to the last digit; allowed is "
                "each specimen once, and measurements of their own as replicates"
            )
        known[content] = each.where


class _Read(NamedTuple):
    """A specimen as its file has it."""

    where: str
    """What errors call it."""
    label: str
    shape: Landmarks | Shape


def _read(file: Path) -> list[_Read]:
    """The specimens of a file."""
    if not is_landmark_file(file):
        return [_Read(str(file), stem_of(file), read(file))]
    sets = read_landmark_sets(file)
    stem = stem_of(file).removesuffix(".mrk")
    if len(sets) == 1:
        return [_Read(str(file), stem, sets[0])]
    return [
        _Read(f"{file}: specimen {i}", each.specimen or f"{stem} {i}", each)
        for i, each in enumerate(sets)
    ]


def _in_order(each: _Read, first: _Read) -> NDArray[np.float64]:
    """The points in the order of the first."""
    shape, like = each.shape, first.shape
    names: tuple[str, ...] = ()
    if isinstance(shape, Landmarks) and isinstance(like, Landmarks):
        points, names = shape.points[_order_of(each.where, shape, first.where, like)], like.names
    elif isinstance(shape, Shape) and isinstance(like, Shape):
        if not np.array_equal(shape.faces, like.faces):  # type: ignore[arg-type]
            raise InvalidInput(
                f"{each.where}: its faces are not those of {first.where}; allowed is one topology"
            )
        points = shape.points
    else:
        raise InvalidInput(
            f"{each.where}: of this and {first.where} one has landmarks and the other is a mesh; "
            "allowed are all of one kind"
        )
    if points.shape != like.points.shape:
        raise InvalidInput(
            f"{each.where}: its points have shape {points.shape}, those of {first.where} "
            f"{like.points.shape}; allowed is one shape"
        )
    missing = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(missing):
        what = listed(names[i] if names else i for i in missing)
        raise InvalidInput(
            f"{each.where}: landmark {what} is missing; allowed are all, in every specimen"
        )
    return points


def _order_of(where: str, own: Landmarks, first: str, like: Landmarks) -> list[int] | slice:
    """What puts the landmarks into the order of the first's names."""
    if not own.names and not like.names:
        return slice(None)
    index_of = {name: i for i, name in enumerate(own.names)}
    if len(index_of) < len(own.names):
        twice = next(name for name in own.names if own.names.count(name) > 1)
        raise InvalidInput(f"{where}: two landmarks are called {twice!r}; allowed is one")
    if index_of.keys() == set(like.names):
        return [index_of[name] for name in like.names]
    lacking = listed(sorted(set(like.names) - index_of.keys())) or "none"
    more = listed(sorted(index_of.keys() - set(like.names))) or "none"
    raise InvalidInput(
        f"{where}: its landmarks are not those of {first}: it misses {lacking} and has {more} besides; "
        "allowed are the same names"
    )


def in_replicates(points: NDArray[np.float64], replicates: int) -> NDArray[np.float64]:
    """(individuals, replicates, k, d) of (n, k, d), those of an individual one behind the other."""
    if replicates < 1:
        raise InvalidParameter(f"replicates is {replicates}; allowed are whole numbers from 1 on")
    if len(points) % replicates:
        raise InvalidInput(
            f"there are {len(points)} specimens; allowed is a multiple of the replicates, {replicates}"
        )
    return points.reshape(-1, replicates, *points.shape[1:])


def closer_to_others(specimens: Specimens, replicates: int) -> list[tuple[str, str]]:
    """Of the specimens whose shape is closest to one of another individual, not to a replicate of
    their own, the names of both."""
    shapes = superimposed(specimens.points).reshape(len(specimens.points), -1)
    products = shapes @ shapes.T
    gaps = np.diag(products)[:, None] + np.diag(products) - 2 * products
    np.fill_diagonal(gaps, np.inf)
    closest = gaps.argmin(axis=1)
    individual = np.arange(len(shapes)) // replicates
    others = np.flatnonzero(individual[closest] != individual)
    return [(specimens.labels[i], specimens.labels[closest[i]]) for i in others]


def paired(specimens: Specimens) -> tuple[Specimens, LandmarkPairs, str]:
    """The specimens, their pairs, and what told them: names; else the mirror of the mean, which is
    found, with the homologous points of a mesh. Where its triangulation is not symmetric, these
    points and the vertices of one side become the landmarks. Raises InvalidInput without a mirror."""
    if any(map(side_of, specimens.names)):
        try:
            return specimens, landmark_pairs(specimens.points[0], None, specimens.names), "names"
        except InvalidInput as error:
            raise InvalidInput(f"{specimens.labels[0]}: {error}") from error
    mean = superimposed(specimens.points).mean(axis=0)
    if mean.shape[1] == 2:
        raise InvalidInput("flat landmarks whose names tell no pairs; allowed is with pairs given")
    mirror, warning = found_mirror(detect(mean, faces=specimens.faces))
    source = f"the mirror found{', of which ' + warning if warning else ''}"
    if specimens.faces is None:
        return specimens, landmark_pairs(mean, mirror, specimens.names or None), source
    shape = Shape(mean, specimens.faces)
    exact = operate(
        "correspondences", shape, mirror, pairing="homologous", max_distance=1, max_angle=90
    )
    assert isinstance(exact, Correspondences)
    if _is_mirrored(specimens.faces, exact.index):
        return specimens, _of_vertices(exact.index), f"{source} and the triangulation"
    found = operate("correspondences", shape, mirror, pairing="homologous")
    assert isinstance(found, Correspondences)
    source += "; the triangulation is not symmetric: directional asymmetry has the error of homologous points in it"
    return *_of_one_side(specimens, found, mirror.signed_distance(mean) > 0), source


def _of_one_side(
    specimens: Specimens, found: Correspondences, is_side: NDArray[np.bool_]
) -> tuple[Specimens, LandmarkPairs]:
    """The vertices of a side, and behind them their homologous points on the other one."""
    assert specimens.faces is not None and found.face is not None and found.weights is not None
    side = np.flatnonzero(is_side & (found.face >= 0))
    count = len(side)
    corners = specimens.points[:, specimens.faces[found.face[side]]]
    others = np.einsum("pc,npcx->npx", found.weights[side], corners)
    index_of = np.full(len(is_side), -1)
    index_of[side] = np.arange(count)
    faces = index_of[specimens.faces]
    faces = faces[(faces >= 0).all(axis=1)]
    pairs = np.arange(2 * count).reshape(2, -1).T
    none = np.empty(0, np.int64)
    return Specimens(
        specimens.labels,
        np.concatenate([specimens.points[:, side], others], axis=1),
        faces=np.concatenate([faces, faces[:, ::-1] + count]),
    ), LandmarkPairs(pairs, none, none)


def _is_mirrored(faces: NDArray[np.int64], index: NDArray[np.int64]) -> bool:
    """Whether each vertex has another, or itself, that mirrors it, and each face."""
    if (index < 0).any() or (index[index] != np.arange(len(index))).any():
        return False
    own, mirrored = (np.unique(np.sort(each, axis=1), axis=0) for each in (faces, index[faces]))
    return np.array_equal(own, mirrored)


def _of_vertices(index: NDArray[np.int64]) -> LandmarkPairs:
    own = np.arange(len(index))
    lower = np.flatnonzero((index > own) & (index[index] == own))
    pairs = np.column_stack([lower, index[lower]])
    midline = np.flatnonzero(index == own)
    return LandmarkPairs(pairs, midline, np.setdiff1d(own, np.append(pairs, midline)))


def read_pairs(path: Path, specimens: Specimens) -> LandmarkPairs:
    """The pairs of a table: two names a row, or two numbers of landmarks, from 0 on. All others are
    on the midline. Raises InvalidInput, naming the file and the line."""
    index_of = {name: i for i, name in enumerate(specimens.names)}
    rows: list[list[int]] = []
    taken: set[int] = set()
    with naming(path), broken("CSV"):
        lines = text_of(path).splitlines()
        for line, cells in enumerate(csv.reader(lines, skipinitialspace=True), 1):
            if cells and not cells[0].startswith("#"):
                row = _row(f"line {line}", cells, index_of, specimens.points.shape[1])
                if row[0] == row[1] or not taken.isdisjoint(row):
                    raise InvalidInput(f"line {line}: one of the two stands twice; allowed is once")
                rows.append(row)
                taken.update(row)
    pairs = np.array(rows, dtype=np.int64).reshape(-1, 2)
    rest = np.setdiff1d(np.arange(specimens.points.shape[1]), pairs)
    return LandmarkPairs(pairs, rest, np.empty(0, np.int64))


def _row(where: str, cells: Sequence[str], index_of: dict[str, int], count: int) -> list[int]:
    if len(cells) != 2:
        raise InvalidInput(f"{where}: there are {len(cells)} cells; allowed are the two of a pair")
    found = []
    for cell in map(str.strip, cells):
        index = index_of.get(cell, int(cell) if cell.isdecimal() else -1)
        if not 0 <= index < count:
            raise InvalidInput(
                f"{where}: {cell!r} is no landmark; allowed are their names, and 0 to {count - 1}"
            )
        found.append(index)
    return found


def without_odd(specimens: Specimens, found: LandmarkPairs) -> tuple[Specimens, LandmarkPairs]:
    """Only the landmarks that have a counterpart."""
    kept = np.sort(np.concatenate([found.pairs.ravel(), found.midline]))
    if not len(found.odd):
        return specimens, found
    index_of = np.full(specimens.points.shape[1], -1)
    index_of[kept] = np.arange(len(kept))
    names = tuple(specimens.names[i] for i in kept) if specimens.names else ()
    rest = LandmarkPairs(index_of[found.pairs], index_of[found.midline], np.empty(0, np.int64))
    return Specimens(specimens.labels, specimens.points[:, kept], names), rest
