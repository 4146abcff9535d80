"""OFF: the rows of the vertices get new coordinates; colours and polygons stay."""

from __future__ import annotations

import numpy as np

from .new_shape import BYTE_ORDER_MARK, LOST_NORMALS, NewShape, Rewritten, row_texts


def rewritten_off(content: bytes, new: NewShape) -> Rewritten:
    rows = [row for row in map(_words, content.removeprefix(BYTE_ORDER_MARK).split(b"\n")) if row]
    keyword, *counts = rows[0]
    if not counts:
        counts = rows.pop(1)
    vertices, faces = int(counts[0]), int(counts[1])
    has_normals = keyword.removeprefix(b"ST").removeprefix(b"C").startswith(b"N")
    drops = has_normals and not new.keeps_normals
    points = [list(rows[1 + source]) for source in new.sources.tolist()]
    for row, coordinates in zip(points, row_texts(new.points)):
        row[:3] = coordinates
    if drops:
        keyword = keyword.replace(b"N", b"")
        for row in points:
            del row[3:6]
    elif has_normals and new.turn is not None:
        normals = np.array([row[3:6] for row in points], dtype=float)
        for row, normal in zip(points, row_texts(new.turned(normals))):
            row[3:6] = normal
    polygons = rows[1 + vertices : 1 + vertices + faces]
    beside = [row[1 + int(row[0]) :] for row in polygons for _ in range(int(row[0]) - 2)]
    added = [
        [b"%d" % len(corners), *map(b"%d".__mod__, corners), *beside[new.face_source(row)]]
        for row, corners in new.added_polygons
    ]
    kept = [] if new.is_other else polygons
    counts[:2] = [b"%d" % len(points), b"%d" % (len(kept) + len(added))]
    made = [[keyword], counts, *points, *kept, *added]
    lost = [LOST_NORMALS] if drops else []
    return Rewritten(
        b"".join(b" ".join(row) + b"\n" for row in made), lost + new.lost_arrays("OFF")
    )


def _words(line: bytes) -> list[bytes]:
    return [] if line.lstrip().startswith(b"#") else line.split()
