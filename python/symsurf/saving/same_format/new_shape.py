"""What an operation has made of a file's points and faces."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...shapes.kinds import (
    UNDIRECTED,
    Carry,
    column_groups,
    kept_as_number,
    unknown_groups,
    with_lengths,
)
from ...shapes.polygons import corners_of
from ...shapes.space import SPACE, TABLE

BYTE_ORDER_MARK = b"\xef\xbb\xbf"  # of UTF-8, which the readers pass over


class Rewritten(NamedTuple):
    """A file's new content."""

    content: bytes
    lost: list[str]
    """What it does not hold, a sentence each."""


@dataclass(frozen=True)
class NewShape:
    """Points and faces that stand behind or in place of a file's own."""

    points: NDArray[np.float64]
    """(n, 3): the file's, moved or not, then those added."""
    faces: NDArray[np.int64]
    """(m, 3): the file's as triangles, then those added."""
    old_faces: int
    """How many of them the file has."""
    sources: NDArray[np.int64]
    """(n,) the file's point that each takes its attributes from."""
    moved: bool
    turn: NDArray[np.float64] | None = None
    """(3, 3) how the normals turn; None where the points did not move as a whole."""
    space: bytes | None = None
    """RAS or LPS, what the axes now mean; None: what they meant before."""
    arrays: dict[str, NDArray[Any]] = field(default_factory=dict)
    """One row per point."""
    face_arrays: dict[str, NDArray[Any]] = field(default_factory=dict)
    """One row per face, where these are none of the file's."""
    is_other: bool = False
    """Whether points and faces are none of the file's: ``old_faces`` is 0 then."""
    given_faces: NDArray[np.int64] | None = None
    """The file's as triangles, where the new ones are others."""
    face_sources: NDArray[np.int64] | None = None
    """(m,) which of those each is a part or an image of."""
    parents: NDArray[np.int64] | None = None
    """(n, k) the file's points that each lies between, where it is another."""
    shares: NDArray[np.float64] | None = None
    """(n, k) what each of these counts."""
    carried: Callable[[NDArray[Any]], NDArray[Any]] | None = None
    """What the points then have of values (k, ...) of the file's, where these are carried over."""
    directed: Carry | None = None
    """What they have of values with directions; None: these do not change."""
    kinds: Mapping[str, str] = field(default_factory=dict)
    """What arrays of the file's are, by their names, as given."""
    polygons: NDArray[np.int64] | None = None
    """(m,) the polygon that each face is a part of; see ``Shape``."""
    reached: Callable[[str], str | None] = lambda name: name
    """The name, from where it is written, of a file beside that which was read; None: there is none."""

    @cached_property
    def added_polygons(self) -> list[tuple[int, list[int]]]:
        """The added faces as their corners, each with the row of its first triangle among all."""
        polygons = None if self.polygons is None else self.polygons[self.old_faces :]
        added = corners_of(self.added_faces, polygons)
        return [(self.old_faces + row, corners) for row, corners in added]

    def face_source(self, row: int) -> int:
        """The triangle of the file that a face comes from."""
        return row if self.face_sources is None else int(self.face_sources[row])

    @property
    def added_faces(self) -> NDArray[np.int64]:
        return self.faces[self.old_faces :]

    @cached_property
    def adds_points(self) -> bool:
        return bool(self.is_other or (self.sources != np.arange(len(self.points))).any())

    @property
    def changes_points(self) -> bool:
        return self.moved or self.adds_points

    @property
    def keeps_normals(self) -> bool:
        """Not where points are images of others: their normals are too."""
        return not self.changes_points or self.turn is not None

    def turned(self, normals: NDArray[Any]) -> NDArray[np.float64]:
        if self.turn is None:
            return normals
        made = np.asarray(normals, dtype=float) @ np.linalg.inv(self.turn)
        return with_lengths(made, np.linalg.norm(normals, axis=1))

    def directed_columns(
        self, names: Iterable[bytes], column: Callable[[bytes], Any]
    ) -> dict[bytes, NDArray[np.float64]]:
        """The columns of the file's arrays with directions, as the points then have them."""
        if self.directed is None:
            return {}
        made: dict[bytes, NDArray[np.float64]] = {}
        for name, kind, group in column_groups([each.decode() for each in names], self.kinds):
            own = [each.encode() for each in group]
            values = np.stack([column(each) for each in own]).T
            values = values if values.dtype.kind == "f" else values.astype(float)
            made.update(zip(own, self.directed(values, kind, name).T, strict=True))
        return made

    def unturned(self, names: Iterable[bytes]) -> list[str]:
        """What to say of columns that may be directions and are not turned."""
        if self.directed is None:
            return []
        own = [each.decode(errors="replace") for each in names]
        found = {name for name, _, _ in column_groups(own, self.kinds)}
        lost = [kept_as_number(name) for name in unknown_groups(own, self.kinds)]
        lost += [
            f"{name}, given as {kind}, is not in the file"
            for name, kind in self.kinds.items()
            if kind not in UNDIRECTED and name not in found
        ]
        return lost

    def of_file(self, name: bytes, values: NDArray[Any]) -> NDArray[Any]:
        """What the points then have of a column of the file's."""
        if self.carried is None or (not self.is_other and name.lower() in _OF_POSITIONS):
            return values[self.sources] if self.adds_points else values
        if values.dtype.kind in "iu" and name.lower() in _COLOURS:
            return self.carried(values.astype(float)).round().astype(values.dtype)
        return self.carried(values)

    def of_words(self, name: bytes, column: list[bytes]) -> list[bytes]:
        """The same of a column of texts: integers and words those of a point's source."""
        if self.carried is None:
            return [column[source] for source in self.sources.tolist()]
        for kind in (np.int64, np.float64):
            with suppress(ValueError):
                return texts(self.of_file(name, np.array(column).astype(kind)))
        return list(self.of_file(name, np.array(column, object)))

    def columns(self) -> dict[str, NDArray[Any]]:
        """The arrays, of vectors each component by itself, as "vector_x"."""
        columns = {}
        for name, values in self.arrays.items():
            if values.ndim == 1:
                columns[name] = values
            else:
                columns |= {f"{name}_{a}": c for a, c in zip("xyz", values.T, strict=True)}
        return columns

    def with_space(self, comment: bytes) -> bytes:
        """A comment of the file, in which the axes are named as they now are."""
        if self.space is None:
            return comment
        if TABLE.match(comment):
            return b"# CoordinateSystem = " + self.space
        return SPACE.sub(b"SPACE=" + self.space, comment)

    def missing_space(self, comments: Iterable[bytes]) -> bytes | None:
        """What names the axes where no comment does."""
        if self.space is None or any(
            SPACE.search(comment) or TABLE.match(comment) for comment in comments
        ):
            return None
        return b"SPACE=" + self.space

    def lost_arrays(self, format_name: str) -> list[str]:
        names = [*self.arrays, *self.face_arrays]
        return [lost_arrays(format_name, names)] if names else []


# Columns that say where a point is and how its surface lies: they stay with it.
_OF_POSITIONS = {*b"x y z nx ny nz s t u v texture_u texture_v".split()}
_COLOURS = {
    prefix + name for prefix in (b"", b"diffuse_") for name in (b"red", b"green", b"blue", b"alpha")
}

LOST_NORMALS = "the normals are left out: they do not fit the new shape"


def lost_arrays(format_name: str, names: Iterable[str]) -> str:
    return f"{format_name} cannot hold the arrays {', '.join(names)}; PLY and VTP can"


def texts(values: NDArray[Any]) -> list[bytes]:
    """Each number with every digit it has; of booleans 0 and 1."""
    plain = values.astype(np.int64) if values.dtype.kind == "b" else values
    return [repr(value).encode() for value in plain.tolist()]


def row_texts(rows: NDArray[np.float64]) -> list[list[bytes]]:
    """Each row as texts."""
    return [[repr(value).encode() for value in row] for row in rows.tolist()]
