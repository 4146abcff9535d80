"""Binary glTF 2.0 (GLB): one mesh or cloud, its arrays as attributes of the points."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..shapes import Shape
from ..shapes.columns import columns_of

_FLOAT, _UINT = 5126, 5125
_POINTS, _TRIANGLES = 0, 4


def shape_glb_bytes(
    shape: Shape,
    arrays: Mapping[str, NDArray[Any]],
    face_arrays: Mapping[str, NDArray[Any]] | None = None,
) -> bytes:
    """The axes stay those of the shape. An array "distance" becomes the attribute "_DISTANCE", of
    vectors one per component; all are of single precision, the only one that glTF has, and points
    are written relative to the centre of their box, which is the position of the node."""
    finite = shape.points[np.isfinite(shape.points).all(axis=1)]
    box = np.array([finite.min(axis=0), finite.max(axis=0)]) if len(finite) else np.zeros((2, 3))
    centre = box.mean(axis=0)
    columns = {f"_{name.upper()}": values for name, values in columns_of(arrays).items()}
    buffers = [(shape.points - centre).astype("<f4"), *(v.astype("<f4") for v in columns.values())]
    primitive = {
        "attributes": {name: k for k, name in enumerate(["POSITION", *columns])},
        "mode": _POINTS,
    }
    if shape.faces is not None and len(shape.faces):
        primitive |= {"indices": len(buffers), "mode": _TRIANGLES}
        buffers.append(shape.faces.ravel().astype("<u4"))
    # All values take 4 bytes, so that every view is aligned.
    ends = np.cumsum([0, *(values.nbytes for values in buffers)]).tolist()
    accessors = [
        {
            "bufferView": k,
            "componentType": _FLOAT if values.dtype.kind == "f" else _UINT,
            "count": len(values),
            "type": "VEC3" if values.ndim == 2 else "SCALAR",
        }
        for k, values in enumerate(buffers)
    ]
    low, high = (box - centre).astype("<f4").tolist()
    tree = {
        "asset": {"version": "2.0", "generator": "symsurf"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": centre.tolist()}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [accessors[0] | {"min": low, "max": high}, *accessors[1:]],
        "bufferViews": [
            {"buffer": 0, "byteOffset": begin, "byteLength": end - begin}
            for begin, end in pairwise(ends)
        ],
        "buffers": [{"byteLength": ends[-1]}],
    }
    return glb_bytes(tree, b"".join(values.tobytes() for values in buffers))


def glb_bytes(tree: Mapping[str, Any], binary: bytes) -> bytes:
    """A description and its only buffer as one file."""
    import json  # `import symsurf` does not wait for it

    text = json.dumps(tree).encode()
    chunks = _chunk(b"JSON", text + b" " * (-len(text) % 4))
    chunks += _chunk(b"BIN\0", binary + b"\0" * (-len(binary) % 4))
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack("<I4s", len(content), kind) + content
