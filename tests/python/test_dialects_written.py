"""What an operation makes of a file in a dialect that the rewriters may not know."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from attributed_files import text
from test_same_format import box, done  # noqa: F401 - box is a fixture

import symsurf


@pytest.mark.parametrize(
    "name", ["plain.off", "glued.off", "long.obj", "capitals.stl", "german.csv"]
)
def test_what_is_written_in_another_way_is_kept_or_written_anew(name, box, tmp_path):  # noqa: F811
    """Never other points: a dialect that is not kept is named."""
    points, faces = box
    rows = [text(point) for point in points.tolist()]
    triangles = [(face[0], *pair) for face in faces for pair in pairwise(face[1:])]
    head, _, suffix = name.partition(".")
    if suffix == "off":
        start = (
            f"OFF{len(points)} {len(faces)} 0"
            if head == "glued"
            else f"OFF\n{len(points)} {len(faces)} 0"
        )
        lines = [start, *rows, *(text([len(face), *face]) for face in faces)]
    elif suffix == "obj":
        lines = [f"v {row}".replace(" ", " \\\n ", 2) for row in rows]
        lines += [text(["f", *(c + 1 for c in face)]) for face in faces]
    elif suffix == "stl":
        lines = ["solid"]
        for triangle in triangles:
            lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {rows[c]}" for c in triangle)]
            lines += ["endloop", "endfacet"]
        lines = "\n".join([*lines, "endsolid", ""]).upper().split("\n")
    else:
        lines = ["X [mm];Y [mm];Z [mm]"]
        lines += [row.replace(" ", ";").replace(".", ",") for row in rows]
    path = tmp_path / name
    path.write_text("\n".join(lines) + "\n")
    made, said = done("align", path)
    expected = symsurf.align(path, symsurf.detect(path, "plane")).shape
    np.testing.assert_array_equal(symsurf.read(made).points, expected.points)
    assert (symsurf.read(made).faces is None) == (suffix == "csv")
    assert ("nothing of the file is kept but points and faces" in said) == (
        head in ("glued", "long", "german")
    )
