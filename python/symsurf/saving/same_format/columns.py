"""XYZ, CSV and TXT: the columns of the coordinates get new values; comments and columns stay."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .new_shape import BYTE_ORDER_MARK, LOST_NORMALS, NewShape, Rewritten, row_texts, texts

_COORDINATES = ((b"x", b"points:0"), (b"y", b"points:1"), (b"z", b"points:2"))
_NORMALS = ((b"nx", b"normals:0"), (b"ny", b"normals:1"), (b"nz", b"normals:2"))


def rewritten_columns(content: bytes, new: NewShape) -> Rewritten:
    comments, rows = [], []
    for line in content.removeprefix(BYTE_ORDER_MARK).split(b"\n"):
        text = line.strip()
        if text.startswith((b"#", b"//")):
            comments.append(new.with_space(text))
        elif text:
            rows.append(text)
    if space := new.missing_space(comments):
        comments.append(b"# " + space)
    separator = next((mark for mark in (b";", b",") if mark in rows[0]), None)
    table = [[word.strip() for word in row.split(separator)] for row in rows]
    commented = _commented_names(comments)
    is_headed = commented is None and not _is_number(table[0][0])
    names = table.pop(0) if is_headed else commented
    if commented is not None:  # more columns would need more names there
        new = replace(new, arrays={})
    coordinates, normals = _places(names, len(table[0]), table)
    stay = {*coordinates, *normals}
    given_columns = [*zip(*table, strict=True)]
    words = [
        [column[source] for source in new.sources.tolist()]
        if number in stay
        else new.of_words(b"" if names is None else names[number], list(column))
        for number, column in enumerate(given_columns)
    ]
    made = [list(row) for row in zip(*words, strict=True)]
    for row, values in zip(made, row_texts(new.points)):
        for column, value in zip(coordinates, values):
            row[column] = value
    if normals and new.turn is not None:
        given = np.array([[float(row[column]) for column in normals] for row in made])
        for row, values in zip(made, row_texts(new.turned(given))):
            for column, value in zip(normals, values):
                row[column] = value
    plain = [] if names is None else _plain(names)
    directed = new.directed_columns(plain, lambda name: given_columns[plain.index(name)])
    for key, turned in directed.items():
        for row, text in zip(made, texts(turned)):
            row[plain.index(key)] = text
    drops = bool(normals) and not new.keeps_normals
    lost = ([LOST_NORMALS] if drops else []) + new.unturned(plain)
    if names is not None:  # more columns are no normals where each has its name
        for name, added in new.columns().items():
            names = [*names, name.encode()]
            for row, text in zip(made, texts(added)):
                row.append(text)
    else:
        lost += new.lost_arrays("a file without names of columns")
    if drops:
        for row in made if names is None else [names, *made]:
            for column in sorted(normals, reverse=True):
                del row[column]
    joint = separator or b" "
    header = [names] if is_headed and names is not None else []
    lines = comments + [joint.join(row) for row in header + made]
    return Rewritten(b"\n".join(lines) + b"\n", lost)


def _commented_names(comments: list[bytes]) -> list[bytes] | None:
    """Those of 3D Slicer's tables of points."""
    for comment in comments:
        if comment.startswith(b"# columns = "):
            return comment.removeprefix(b"# columns = ").split(b",")
    return None


def _plain(names: list[bytes]) -> list[bytes]:
    return [name.replace(b'"', b"") for name in names]


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _places(
    names: list[bytes] | None, width: int, table: list[list[bytes]]
) -> tuple[list[int], list[int]]:
    """The columns of the coordinates and of the normals, as the reader tells them."""
    if names is None:
        values = np.array([row[3:6] for row in table], dtype=float) if width == 6 else np.empty(0)
        colours = values.size and (values == values.round()).all() and 1 < values.max() <= 255
        return [0, 1, 2], [3, 4, 5] if values.size and not (colours and values.min() >= 0) else []
    plain = [name.lower() for name in _plain(names)]
    found = [
        [next((plain.index(n) for n in either if n in plain), -1) for either in group]
        for group in (_COORDINATES, _NORMALS)
    ]
    return found[0], [] if -1 in found[1] else found[1]
