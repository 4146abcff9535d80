"""OBJ of other points and faces: texture coordinates, materials, groups and colours go along."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .new_shape import BYTE_ORDER_MARK, LOST_NORMALS, NewShape, Rewritten, row_texts

# What is said of all faces that follow, by its place in their state.
_GROUPED = {b"usemtl": 0, b"s": 1, b"o": 2, b"g": 3}


class _Source:
    """What the file says of its vertices and triangles."""

    def __init__(self, content: bytes) -> None:
        self.head: list[bytes] = []
        """Comments, and the libraries of materials."""
        self.rests: list[list[bytes]] = []
        """Of each vertex the words behind its coordinates."""
        self.texture: list[list[float]] = []
        self.corners: list[tuple[int, ...]] = []
        """Of each triangle its vertices."""
        self.textured: list[tuple[int, ...]] = []
        """Of each its texture coordinates, -1 for none."""
        self.states: list[tuple[bytes, ...]] = []
        """Of each the lines that say what it is made of and belongs to."""
        self.has_normals = False
        state = [b""] * len(_GROUPED)
        for line in content.removeprefix(BYTE_ORDER_MARK).split(b"\n"):
            words = line.split(b"#", 1)[0].split()
            keyword = words[0] if words else b""
            if line.rstrip().endswith(b"\\"):
                raise ValueError("a statement over several lines is not kept")
            if keyword == b"v":
                self.rests.append(words[4:])
            elif keyword == b"vt":
                self.texture.append([float(word) for word in words[1:]])
            elif keyword == b"f":
                self._add(words[1:], tuple(state))
            elif keyword in _GROUPED:
                state[_GROUPED[keyword]] = line.rstrip()
            elif keyword == b"mtllib" or line.startswith(b"#"):
                self.head.append(line.rstrip())
            self.has_normals = self.has_normals or keyword == b"vn"

    def _add(self, words: list[bytes], state: tuple[bytes, ...]) -> None:
        corners = []
        for word in words:
            vertex, texture, *_ = [*word.split(b"/"), b""]
            corners.append(
                (_position(vertex, len(self.rests)), _position(texture, len(self.texture)))
            )
        for k in range(1, len(corners) - 1):
            vertices, textured = zip(corners[0], corners[k], corners[k + 1])
            self.corners.append(vertices)
            self.textured.append(textured)
            self.states.append(state)


def other_obj(content: bytes, new: NewShape) -> Rewritten:
    """The file with the new shape in place of its own. Raises ValueError where its triangles are not
    those that were read."""
    source = _Source(content)
    assert new.given_faces is not None
    if not np.array_equal(np.array(source.corners).reshape(-1, 3), new.given_faces):
        raise ValueError("the triangles are not those of the file's lines")
    columns = [list(column) for column in zip(*source.rests, strict=True)]
    rests = [new.of_words(b"colour", column) for column in columns]
    vertices = [
        b"v " + b" ".join([*coordinates, *(column[i] for column in rests)])
        for i, coordinates in enumerate(row_texts(new.points))
    ]
    coordinates, numbers = _texture_of(source, new)
    lines = [*source.head, *vertices]
    lines += [b"vt " + b" ".join(words) for words in row_texts(coordinates)]
    assert new.face_sources is not None
    states = [source.states[face] for face in new.face_sources.tolist()]
    for name, is_so in new.face_arrays.items():
        states = [
            (*state[:-1], b"g " + name.encode()) if so else state
            for state, so in zip(states, is_so)
        ]
    said: tuple[bytes, ...] = ()
    for state, face, textured in zip(states, new.faces.tolist(), numbers.tolist(), strict=True):
        lines += [line for line in state if line and line not in said]
        said = state
        words = [
            b"%d/%d" % (corner + 1, number + 1) if number >= 0 else b"%d" % (corner + 1)
            for corner, number in zip(face, textured)
        ]
        lines.append(b"f " + b" ".join(words))
    notices = [LOST_NORMALS] if source.has_normals else []
    lost = new.lost_arrays("OBJ") if new.arrays else []
    return Rewritten(b"\n".join([*lines, b""]), notices + lost)


def _texture_of(source: _Source, new: NewShape) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Texture coordinates, and of each corner of the new faces which it has, -1 for none."""
    none = np.full(new.faces.shape, -1)
    if not source.texture:
        return np.empty((0, 2)), none
    given = np.array([row[:2] for row in source.texture])
    assert new.parents is not None and new.shares is not None
    corners, textured = np.array(source.corners), np.array(source.textured)
    of_vertex = np.full(len(source.rests), -1)  # one of them, for points of other faces
    of_vertex[corners[::-1].ravel()] = textured[::-1].ravel()
    sums = np.zeros((*new.faces.shape, 2))
    has_all = np.ones(new.faces.shape, bool)
    own, own_textured = corners[new.face_sources], textured[new.face_sources]
    for k in range(new.parents.shape[1]):
        parent, share = new.parents[new.faces, k], new.shares[new.faces, k]
        number = of_vertex[parent]
        for corner in range(3):
            is_here = own[:, [corner]] == parent
            number = np.where(is_here, own_textured[:, [corner]], number)
        has_all &= (number >= 0) | (share == 0)
        sums += share[..., None] * given[number]
    rows, places = np.unique(sums[has_all], axis=0, return_inverse=True)
    none[has_all] = places.ravel()
    return rows, none


def _position(word: bytes, count: int) -> int:
    """From 0; -1 for none."""
    number = int(word) if word else 0
    return number - 1 if number >= 0 else count + number
