"""STL, text and binary: triangles and their normals are written anew; the header stays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .new_shape import NewShape, Rewritten, row_texts

_HEADER = 80
_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def rewritten_stl(content: bytes, new: NewShape) -> Rewritten:
    corners = new.points[new.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    count = int.from_bytes(content[_HEADER : _HEADER + 4], "little")
    is_text = (
        content.lstrip()[:5].lower() == b"solid"
        and len(content) != _HEADER + 4 + count * _FACET.itemsize
        and b"\0" not in content[: _HEADER + 4 + _FACET.itemsize]
    )
    if is_text:
        return _text(content, corners, normals, new)
    made = np.zeros(len(corners), _FACET)
    made["normal"], made["corners"] = normals, corners
    old = np.frombuffer(content, _FACET, count, _HEADER + 4)
    made["attribute"][:count] = old["attribute"]
    header = new.with_space(content[:_HEADER])
    if space := new.missing_space([header]):
        header = header.rstrip(b"\0 ")[: _HEADER - len(space) - 1] + b" " + space
    content = header.ljust(_HEADER, b" ") + len(made).to_bytes(4, "little") + made.tobytes()
    lost = new.lost_arrays("STL")
    if new.moved and (made["corners"] != corners).any():
        lost.append("binary STL rounds coordinates to single precision; PLY keeps every digit")
    return Rewritten(content, lost)


def _text(
    content: bytes, corners: NDArray[np.float64], normals: NDArray[np.float64], new: NewShape
) -> Rewritten:
    lines = [line for line in content.split(b"\n") if line.split()[:1] in ([b"solid"], [b"SOLID"])]
    name = b"solid" + new.with_space(lines[0].strip())[5:]
    if space := new.missing_space([name]):
        name += b" " + space
    made = [name]
    for normal, triangle in zip(row_texts(normals), corners):
        made += [b"facet normal " + b" ".join(normal), b"outer loop"]
        made += [b"vertex " + b" ".join(corner) for corner in row_texts(triangle)]
        made += [b"endloop", b"endfacet"]
    made += [b"end" + name, b""]
    lost = new.lost_arrays("STL")
    if len(lines) > 1:
        lost.append(f"the {len(lines)} solids are written as one")
    return Rewritten(b"\n".join(made), lost)
