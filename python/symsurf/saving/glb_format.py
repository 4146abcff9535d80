"""Binary glTF 2.0 (GLB): one mesh or cloud, its arrays as attributes of the points."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..shapes import Shape
from ..shapes.columns import columns_of

_FLOAT, _UINT = 5126, 5125
_POINTS, _TRIANGLES = 0, 4
_TYPES = {1: "SCALAR", 3: "VEC3"}


def shape_glb_bytes(
    shape: Shape,
    arrays: Mapping[str, NDArray[Any]],
    face_arrays: Mapping[str, NDArray[Any]] | None = None,
) -> bytes:
    """The axes stay those of the shape. An array "distance" becomes the attribute "_DISTANCE", of
    vectors one per component; all are of single precision, the only one that glTF has, and points
    are written relative to the centre of their box, which is the position of the node."""
    import json  # `import symsurf` does not wait for it

    finite = shape.points[np.isfinite(shape.points).all(axis=1)]
    box = np.array([finite.min(axis=0), finite.max(axis=0)]) if len(finite) else np.zeros((2, 3))
    centre = box.mean(axis=0)
    binary = _Binary()
    points = (shape.points - centre).astype("<f4")
    low, high = (box - centre).astype("<f4").tolist()
    attributes = {"POSITION": binary.add(points, _FLOAT, min=low, max=high)}
    for name, values in columns_of(arrays).items():
        attributes[f"_{name.upper()}"] = binary.add(values[:, None].astype("<f4"), _FLOAT)
    primitive: dict[str, Any] = {"attributes": attributes, "mode": _POINTS}
    if shape.faces is not None and len(shape.faces):
        corners = shape.faces.reshape(-1, 1).astype("<u4")
        primitive |= {"indices": binary.add(corners, _UINT), "mode": _TRIANGLES}
    tree = {
        "asset": {"version": "2.0", "generator": "symsurf"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": centre.tolist()}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": binary.accessors,
        "bufferViews": binary.views,
        "buffers": [{"byteLength": len(binary.content)}],
    }
    text = json.dumps(tree).encode()
    chunks = _chunk(b"JSON", text + b" " * (-len(text) % 4)) + _chunk(b"BIN\0", binary.content)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _chunk(kind: bytes, content: bytes | bytearray) -> bytes:
    return struct.pack("<I4s", len(content), kind) + content


class _Binary:
    """The buffer, of which every array has a view and an accessor."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, values: NDArray[Any], kind: int, **bounds: Any) -> int:
        """The number of the accessor. All values take 4 bytes, so that every view is aligned."""
        view = {"buffer": 0, "byteOffset": len(self.content), "byteLength": values.nbytes}
        self.accessors.append(
            {
                "bufferView": len(self.views),
                "componentType": kind,
                "count": len(values),
                "type": _TYPES[values.shape[1]],
                **bounds,
            }
        )
        self.views.append(view)
        self.content += values.tobytes()
        return len(self.accessors) - 1
