"""OBJ of other points and faces: texture coordinates, materials, groups and colours go along."""

from __future__ import annotations

import os

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
        self.state: tuple[bytes, ...] = tuple(state)
        """That of the last line."""
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
        self.state = tuple(state)

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
    columns = [list(column) for column in zip(*source.rests, strict=True)]
    rests = [new.of_words(b"colour", column) for column in columns]
    vertices = [
        b"v " + b" ".join([*coordinates, *(column[i] for column in rests)])
        for i, coordinates in enumerate(row_texts(new.points))
    ]
    head, lost = with_libraries(source.head, new)
    lines = [*head, *vertices, *_added_lines(source, new, 0, ())]
    lost += [LOST_NORMALS] if source.has_normals else []
    lost += new.lost_arrays("OBJ") if new.arrays else []
    return Rewritten(b"\n".join([*lines, b""]), lost)


def added_lines(content: bytes, new: NewShape) -> list[bytes]:
    """Those of the faces behind the file's. Raises ValueError as ``other_obj`` does."""
    source = _Source(content)
    return _added_lines(source, new, len(source.texture), source.state)


def with_libraries(lines: list[bytes], new: NewShape) -> tuple[list[bytes], list[str]]:
    """The lines, those of libraries of materials with the names that these have from where the file is
    written; and what to say of those that are not there."""
    made, lost = [], []
    for line in lines:
        if line.split(None, 1)[:1] != [b"mtllib"]:
            made.append(line)
            continue
        whole = os.fsdecode(line.split(None, 1)[1].strip())
        for name in [whole] if new.reached(whole) else whole.split():
            reached = new.reached(name)
            if reached is None:
                lost.append(f"the library of materials {name} is not beside the file")
            made.append(b"mtllib " + os.fsencode(reached or name))
    return made, lost


def _added_lines(
    source: _Source, new: NewShape, textures: int, said: tuple[bytes, ...]
) -> list[bytes]:
    """Of the added faces, one material after the other.

    Args:
        textures: how many texture coordinates there are before.
        said: the lines that hold for the faces before.
    """
    assert new.given_faces is not None
    if not np.array_equal(np.array(source.corners).reshape(-1, 3), new.given_faces):
        raise ValueError("the triangles are not those of the file's lines")
    coordinates, numbers = _texture_of(source, new)
    lines = [b"vt " + b" ".join(words) for words in row_texts(coordinates)]
    stated: dict[tuple[bytes, ...], list[bytes]] = {
        state: [] for state in source.states
    }  # in their order
    assert new.face_sources is not None
    for row, corners in new.added_polygons:
        state = source.states[new.face_sources[row]]
        for name, is_so in new.face_arrays.items():
            state = (*state[:-1], b"g " + name.encode()) if is_so[row] else state
        texture = numbers[row]
        words = [
            b"%d/%d" % (corner + 1, textures + texture[corner] + 1)
            if corner in texture
            else b"%d" % (corner + 1)
            for corner in corners
        ]
        stated.setdefault(state, []).append(b"f " + b" ".join(words))
    for state, faces in stated.items():
        if faces:
            lines += [line for line in state if line and line not in said] + faces
            said = state
    return lines


def _texture_of(
    source: _Source, new: NewShape
) -> tuple[NDArray[np.float64], dict[int, dict[int, int]]]:
    """Texture coordinates of the added faces, and, by the row of the first triangle of each, which its
    corners have."""
    rows = np.arange(new.old_faces, len(new.faces))
    if not source.texture or not len(rows):
        return np.empty((0, 2)), {int(row): {} for row in rows}
    parents, shares = new.parents, new.shares
    if parents is None or shares is None:
        parents, shares = new.sources[:, None], np.ones((len(new.sources), 1))
    faces = new.faces[rows]
    given = np.array([row[:2] for row in source.texture])
    corners, textured = np.array(source.corners), np.array(source.textured)
    of_vertex = np.full(len(source.rests), -1)  # one of them, for points of other faces
    of_vertex[corners[::-1].ravel()] = textured[::-1].ravel()
    sums = np.zeros((*faces.shape, 2))
    has_all = np.ones(faces.shape, bool)
    assert new.face_sources is not None
    own, own_textured = corners[new.face_sources[rows]], textured[new.face_sources[rows]]
    for k in range(parents.shape[1]):
        parent, share = parents[faces, k], shares[faces, k]
        number = of_vertex[parent]
        for corner in range(3):
            is_here = own[:, [corner]] == parent
            number = np.where(is_here, own_textured[:, [corner]], number)
        has_all &= (number >= 0) | (share == 0)
        sums += share[..., None] * given[number]
    coordinates, places = np.unique(sums[has_all], axis=0, return_inverse=True)
    numbers = np.full(faces.shape, -1)
    numbers[has_all] = places.ravel()
    found: dict[int, dict[int, int]] = {}
    ends = [row for row, _ in new.added_polygons[1:]] + [len(new.faces)]
    for (row, _), end in zip(new.added_polygons, ends):
        own_rows = slice(row - new.old_faces, end - new.old_faces)
        pairs = zip(faces[own_rows].ravel().tolist(), numbers[own_rows].ravel().tolist())
        found[row] = {corner: number for corner, number in pairs if number >= 0}
    return coordinates, found


def _position(word: bytes, count: int) -> int:
    """From 0; -1 for none."""
    number = int(word) if word else 0
    return number - 1 if number >= 0 else count + number
