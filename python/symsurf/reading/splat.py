"""Gaussian splats: ``.splat``, 32 bytes each, by the viewer of A. Kwok ("antimatter15") that defines
it; and what their opacity is in PLY."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape
from .location import content_of
from .ply_header import END, TYPES, elements_of

SPLAT = np.dtype(
    [("position", "<f4", 3), ("scale", "<f4", 3), ("colour", "u1", 4), ("rotation", "u1", 4)]
)
"""Scales are semi-axes, colours red, green, blue and opacity, rotations quaternions (w, x, y, z) as
128 q + 128."""


def read(path: Path, reading: Reading) -> Shape:
    """The centres, with colours, and the opacity as weights."""
    content = content_of(path)
    if len(content) % SPLAT.itemsize:
        raise InvalidInput(
            f"it has {len(content)} bytes; allowed is a multiple of {SPLAT.itemsize}, a splat each"
        )
    table = np.frombuffer(content, SPLAT)
    return Shape(
        table["position"].astype(float),
        colours=table["colour"][:, :3].astype(float),
        weights=table["colour"][:, 3] / 255.0,
    )


def ply_opacity(path: Path) -> NDArray[np.float64] | None:
    """(n,) 0 to 1 of the splats in a binary PLY file, the logistic function of what it has; None of
    another file."""
    with path.open("rb") as file:
        head = file.read(1 << 16)
    end = END.search(head)
    if end is None or b"opacity" not in head[: end.start()] or b"rot_3" not in head[: end.start()]:
        return None
    lines = head[: end.start()].splitlines()
    encoding = next((line.split()[1] for line in lines if line.startswith(b"format ")), b"ascii")
    vertices = elements_of(lines)[0]
    kinds = [words[0].decode() for words in vertices.properties]
    if encoding == b"ascii" or vertices.name != b"vertex" or not {*kinds} <= {*TYPES}:
        return None
    order = "<" if b"little" in encoding else ">"
    names = [words[1].decode() for words in vertices.properties]
    fields = [(name, order + TYPES[kind]) for name, kind in zip(names, kinds)]
    table = np.memmap(path, np.dtype(fields), "r", end.end(), (vertices.count,))
    return 1 / (1 + np.exp(-np.asarray(table["opacity"], dtype=float)))
