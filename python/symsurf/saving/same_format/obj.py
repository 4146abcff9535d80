"""OBJ: the lines of the vertices get new coordinates; texture coordinates, materials, groups,
colours and polygons stay."""

from __future__ import annotations

import re

import numpy as np

from .new_shape import BYTE_ORDER_MARK, LOST_NORMALS, NewShape, Rewritten, row_texts
from .obj_faces import added_lines, with_libraries

# A corner up to its second slash, from the start of a word, so that long words take no longer.
_CORNER = re.compile(rb"(?<!\S)([^/\s]+/[^/\s]*)/[^/\s]*")


def rewritten_obj(content: bytes, new: NewShape) -> Rewritten:
    lines = content.removeprefix(BYTE_ORDER_MARK).split(b"\n")
    coordinates = row_texts(new.points) if new.changes_points else []
    made: list[bytes] = []
    rests: list[bytes] = []
    is_face = lost = False
    for line in lines:
        words = line.split(None, 4)
        keyword = words[0] if words else b""
        is_face = keyword == b"f" or (is_face and made[-1].rstrip().endswith(b"\\"))
        if keyword in (b"v", b"vn") and line.rstrip().endswith(b"\\"):
            raise ValueError("a vertex over several lines is not kept")
        if keyword == b"v":
            rests.append(words[4].rstrip() if len(words) > 4 else b"")
            if new.moved:
                line = _vertex(coordinates[len(rests) - 1], rests[-1])
        elif keyword == b"vn" and not new.keeps_normals:
            lost = True
            continue
        elif keyword == b"vn" and new.turn is not None:
            normal = new.turned(np.array([words[1:4]], dtype=float))
            line = b"vn " + b" ".join(row_texts(normal)[0])
        elif keyword.startswith(b"#"):
            line = new.with_space(line)
        elif is_face and not new.keeps_normals:
            line = _CORNER.sub(lambda corner: corner[1].rstrip(b"/"), line)
        made.append(line)
    if new.carried is not None and not new.is_other:
        _carry_colours(made, rests, new)
    if space := new.missing_space(line for line in lines if line.startswith(b"#")):
        made.insert(0, b"# " + space)
    if new.adds_points or len(new.added_faces):
        made = b"\n".join(made).rstrip().split(b"\n")
        made += [
            _vertex(coordinates[i], rests[new.sources[i]])
            for i in range(len(rests), len(new.points))
        ]
        made += [*added_lines(content, new), b""] if len(new.added_faces) else [b""]
    made, notices = with_libraries(made, new)
    notices += [LOST_NORMALS] if lost else []
    return Rewritten(b"\n".join(made), notices + new.lost_arrays("OBJ"))


def _carry_colours(lines: list[bytes], rests: list[bytes], new: NewShape) -> None:
    """Gives the vertices what they then have behind their coordinates."""
    columns = list(zip(*(rest.split() for rest in rests), strict=True))
    words = [new.of_words(b"colour", list(column)) for column in columns]
    vertices = (i for i, line in enumerate(lines) if line.split(None, 1)[:1] == [b"v"])
    for i, *rest in zip(vertices, *words, strict=True):
        lines[i] = _vertex(lines[i].split()[1:4], b" ".join(rest))


def _vertex(coordinates: list[bytes], rest: bytes) -> bytes:
    return b"v " + b" ".join([*coordinates, rest] if rest else coordinates)
