"""PLY, text and binary: the vertices get new coordinates and more properties, the rest stays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..._core import InvalidInput
from ...reading.ply_header import END, TYPES, Element, elements_of
from ...shapes import Shape
from ..ply_format import face_rows, shape_ply_bytes
from .new_shape import LOST_NORMALS, NewShape, Rewritten, row_texts, texts

_KINDS = {"f": "f8", "i": "i4", "b": "u1"}
_NAMES = {"f": b"double", "i": b"int", "b": b"uchar"}  # of the properties that are added
_BLOCK = 1 << 13
_CHANGED = "the file was changed after it was read"


def rewritten_ply(content: bytes, new: NewShape) -> Rewritten:
    end = END.search(content)
    if end is None:
        raise InvalidInput(_CHANGED)
    lines = content[: end.start()].splitlines()
    elements = elements_of(lines)
    if not _is_plain(elements, new):
        plain = shape_ply_bytes(
            Shape(new.points, new.faces, polygons=new.polygons), new.arrays, new.face_arrays
        )
        return Rewritten(plain, ["nothing of the file is kept but points and faces"])
    encoding = next(line.split()[1] for line in lines if line.split()[:1] == [b"format"])
    if encoding == b"ascii":
        body = _text_body(content[end.end() :], elements, new)
    else:
        order = "<" if b"little" in encoding else ">"
        body = _binary_body(content[end.end() :], elements, new, order)
    header = b"\n".join(_header(lines, elements, new))
    names = {words[-1] for words in elements[0].properties}
    lost = [] if new.keeps_normals or b"nx" not in names else [LOST_NORMALS]
    lost += new.unturned(words[1] for _, words in _kept(elements[0], new))
    return Rewritten(header + b"\nend_header\n" + body, lost)


def _is_plain(elements: list[Element], new: NewShape) -> bool:
    """Whether the vertices come first, each of one size with a name a property, and faces that are
    added have a place."""
    vertices, *rest = elements
    if vertices.name != b"vertex" or any(words[0] == b"list" for words in vertices.properties):
        return False
    if len({words[-1] for words in vertices.properties}) < len(vertices.properties):
        return False
    if not len(new.added_faces):
        return True
    if len(rest) != 1 or rest[0].name != b"face":
        return False
    kinds = [words[0] for words in rest[0].properties]
    return kinds == [b"list"] and len(new.points) <= _count_held(rest[0].properties[0][2])


def _count_held(kind: bytes) -> int:
    """Of how many points a type holds every index."""
    held = np.dtype(TYPES[kind.decode()])
    return 2 ** (np.finfo(held).nmant + 1) if held.kind == "f" else int(np.iinfo(held).max) + 1


def _kept(element: Element, new: NewShape) -> list[tuple[int, list[bytes]]]:
    """The properties of the vertices that stay, with their columns."""
    left_out = {name.encode() for name in new.columns()}
    if not new.keeps_normals:
        left_out |= {b"nx", b"ny", b"nz"}
    return [(i, words) for i, words in enumerate(element.properties) if words[1] not in left_out]


def _header(lines: list[bytes], elements: list[Element], new: NewShape) -> list[bytes]:
    vertices = elements[0]
    first, last = vertices.line, vertices.line + 1
    while last < len(lines) and lines[last].split()[:1] != [b"element"]:
        last += 1
    comments = [line for line in lines if line.split()[:1] in ([b"comment"], [b"obj_info"])]
    lines = [new.with_space(line) if line in comments else line for line in lines]
    before, after = lines[:first], lines[last:]
    if space := new.missing_space(comments):
        before.append(b"comment " + space)
    inside = [
        line for line in lines[first:last] if line.split()[:1] in ([b"comment"], [b"obj_info"])
    ]

    def is_made_real(words: list[bytes]) -> bool:
        is_moved = new.changes_points and words[1] in (b"x", b"y", b"z")
        return is_moved and np.dtype(TYPES[words[0].decode()]).kind != "f"

    properties = [
        b"property " + (_NAMES["f"] if is_made_real(words) else words[0]) + b" " + words[1]
        for _, words in _kept(vertices, new)
    ]
    added = [
        b"property " + _NAMES[values.dtype.kind] + b" " + name.encode()
        for name, values in new.columns().items()
    ]
    count = b"element vertex %d" % len(new.points)
    if len(new.added_faces):
        after += [
            b"property " + _NAMES[values.dtype.kind] + b" " + name.encode()
            for name, values in new.face_arrays.items()
        ]
        old = 0 if new.is_other else elements[1].count
        after = [
            b"element face %d" % (old + len(new.added_polygons))
            if line.split()[:2] == [b"element", b"face"]
            else line
            for line in after
        ]
    return [*before, count, *inside, *properties, *added, *after]


def _text_body(body: bytes, elements: list[Element], new: NewShape) -> bytes:
    vertices = elements[0]
    rows: list[list[bytes]] = []
    position = 0
    while len(rows) < vertices.count:
        if position > len(body):
            raise InvalidInput(_CHANGED)
        end = body.find(b"\n", position)
        end = len(body) if end < 0 else end
        row = body[position:end].split()
        if row and row[0] not in (b"comment", b"obj_info"):
            rows.append(row)
        position = end + 1
    kept = _kept(vertices, new)
    names = [words[1] for _, words in kept]
    carried = [new.of_words(words[1], [row[i] for row in rows]) for i, words in kept]
    made = [list(row) for row in zip(*carried, strict=True)]
    if new.changes_points:
        _replace(made, names, (b"x", b"y", b"z"), new.points)
    directed = new.directed_columns(
        names, lambda name: [row[kept[names.index(name)][0]] for row in rows]
    )
    if directed:
        _replace(made, names, tuple(directed), np.column_stack([*directed.values()]))
    if new.turn is not None and b"nx" in names:
        columns = [names.index(name) for name in (b"nx", b"ny", b"nz")]
        normals = np.array([[float(row[c]) for c in columns] for row in made]).reshape(-1, 3)
        _replace(made, names, (b"nx", b"ny", b"nz"), new.turned(normals))
    for values in new.columns().values():
        for row, text in zip(made, texts(values)):
            row.append(text)
    text = b"".join(b" ".join(row) + b"\n" for row in made)
    if not new.is_other:
        text += body[position:]
    if len(new.added_faces):
        text = text.rstrip() + b"\n"
        rest = [
            b"".join(b" " + word for word in row)
            for row in zip(*map(texts, new.face_arrays.values()))
        ]
        text += b"".join(
            b"%d %s%s\n"
            % (len(corners), b" ".join(map(b"%d".__mod__, corners)), rest[row] if rest else b"")
            for row, corners in new.added_polygons
        )
    return text


def _replace(
    rows: list[list[bytes]], names: list[bytes], chosen: tuple[bytes, ...], values: NDArray[Any]
) -> None:
    columns = [names.index(name) for name in chosen]
    for row, numbers in zip(rows, row_texts(values)):
        for column, number in zip(columns, numbers):
            row[column] = number


def _binary_body(body: bytes, elements: list[Element], new: NewShape, order: str) -> bytes:
    vertices = elements[0]
    fields = [
        (f"{i}", order + TYPES[kind.decode()]) for i, (kind, _) in enumerate(vertices.properties)
    ]
    whole = np.frombuffer(body, fields, vertices.count)
    table = {name: np.empty(len(whole), kind) for name, kind in fields}
    for block in _blocks(len(whole)):
        for field, values in table.items():
            values[block] = whole[field][block]
    kept = _kept(vertices, new)
    columns: dict[bytes, NDArray[Any]] = {}
    for i, (_, name) in kept:
        columns[name] = new.of_file(name, table[f"{i}"])
    if new.changes_points:
        for name, values in zip((b"x", b"y", b"z"), new.points.T):
            own = columns[name].dtype
            columns[name] = values.astype(own if own.kind == "f" else order + "f8")
    numbers = {name: f"{i}" for i, (_, name) in kept}
    for name, values in new.directed_columns(numbers, lambda name: table[numbers[name]]).items():
        columns[name] = values.astype(columns[name].dtype)
    if new.turn is not None and b"nx" in columns:
        names = (b"nx", b"ny", b"nz")
        normals = np.column_stack([columns[name] for name in names]).astype(float)
        for name, values in zip(names, new.turned(normals).T):
            columns[name] = values.astype(columns[name].dtype)
    for key, values in new.columns().items():
        columns[key.encode()] = values.astype(order + _KINDS[values.dtype.kind])
    made = np.empty(len(new.points), [(str(i), v.dtype) for i, v in enumerate(columns.values())])
    for block in _blocks(len(made)):
        for i, values in enumerate(columns.values()):
            made[str(i)][block] = values[block]
    rest = b"" if new.is_other else body[whole.nbytes :]
    return made.tobytes() + rest + _binary_faces(elements, new, order)


def _blocks(count: int) -> Iterator[slice]:
    """Rows that the processor's cache holds while column after column is taken."""
    return (slice(first, first + _BLOCK) for first in range(0, count, _BLOCK))


def _binary_faces(elements: list[Element], new: NewShape, order: str) -> bytes:
    if not len(new.added_faces):
        return b""
    _, length, corner, _ = elements[1].properties[0]
    polygons = None if new.polygons is None else new.polygons[new.old_faces :]
    kinds = (order + TYPES[kind.decode()] for kind in (length, corner))
    return face_rows(new.added_faces, polygons, list(new.face_arrays.values()), *kinds)[1]
