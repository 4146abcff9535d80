"""The scenes of glTF 2.0, by its definition: GLB and GLTF."""

from __future__ import annotations

import base64
import json
import struct
from collections import deque
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape
from .location import content_of, referenced, require_memory
from .parts import Part, joined, require_parts, strips

# Extensions that change no point, and that of coordinates in small integers.
_KNOWN = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_mesh_quantization")
_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_COMPONENTS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6  # the modes that make faces


def read(path: Path, reading: Reading) -> Shape:
    """All meshes and clouds of the scene, each where the scene has it, as one shape.

    The axes are those of the file: y is up.
    """
    tree, binary = tree_and_binary(content_of(path))
    version = str(tree["asset"]["version"])
    if not version.startswith("2."):
        raise InvalidInput(f"glTF's version is {version}; 2.0 can be read")
    for name in tree.get("extensionsRequired", []):
        if not name.startswith(_KNOWN):
            raise InvalidInput(f"it requires the extension {name}, which cannot be read")
    return joined(Scene(tree, binary, path, reading).parts(), path.stat().st_size)


def tree_and_binary(content: bytes) -> tuple[dict[str, Any], bytes | None]:
    """The description of a file, and the buffer that a GLB has behind it."""
    if not content.startswith(b"glTF"):
        return json.loads(content.decode("utf-8-sig")), None
    if len(content) < 20 or struct.unpack_from("<I", content, 4)[0] != 2:
        raise InvalidInput("this is no GLB file of version 2")
    chunks: dict[bytes, bytes] = {}
    position = 12
    while position + 8 <= len(content):
        length, kind = struct.unpack_from("<I4s", content, position)
        chunk = content[position + 8 : position + 8 + length]
        if len(chunk) < length:
            raise InvalidInput(f"the file is truncated: a part of {length} bytes has {len(chunk)}")
        chunks.setdefault(kind, chunk)
        position += 8 + length
    return json.loads(chunks[b"JSON"]), chunks.get(b"BIN\0")


Primitives = list[dict[str, Any]]


class Scene:
    """What a file describes; ``path`` and ``reading``: for buffers in files beside it."""

    def __init__(
        self,
        tree: dict[str, Any],
        binary: bytes | bytearray | None,
        path: Path | None = None,
        reading: Reading | None = None,
    ) -> None:
        self._tree, self._path, self._reading, self._binary = tree, path, reading, binary
        self._buffers: dict[int, bytes | bytearray] = {}
        self._files: dict[Path, bytes] = {}
        self._primitives = 0

    def parts(self) -> Iterator[Part]:
        """What ``groups`` gives, with points and faces."""
        for place, primitives, matrix in self.groups():
            count = len(self.stored(place, "VEC3"))
            faces = sum(self._most_faces(primitive, count) for primitive in primitives)
            yield Part(count, faces, partial(self._made, place, primitives), matrix)

    def groups(self) -> Iterator[tuple[int, Primitives, NDArray[np.float64]]]:
        """The accessor of points, the primitives that have them, and where the scene has these, in the
        order of the points of the shape."""
        nodes = self._tree.get("nodes", [])
        scenes = self._tree.get("scenes", [])
        if not scenes:
            for mesh in self._tree.get("meshes", []):
                yield from self._mesh(mesh, np.eye(4))
            return
        left = deque((i, np.eye(4)) for i in scenes[self._tree.get("scene", 0)].get("nodes", []))
        seen: set[int] = set()
        while left:
            number, above = left.popleft()
            if number in seen:
                raise InvalidInput(f"node {number} stands in the scene twice")
            seen.add(number)
            node = nodes[number]
            if "EXT_mesh_gpu_instancing" in node.get("extensions", {}):
                raise InvalidInput("it has EXT_mesh_gpu_instancing, which cannot be read")
            matrix = above @ _matrix(node)
            if "mesh" in node:
                yield from self._mesh(self._tree["meshes"][node["mesh"]], matrix)
            left += [(child, matrix) for child in node.get("children", [])]

    def _mesh(
        self, mesh: dict[str, Any], matrix: NDArray[np.float64]
    ) -> Iterator[tuple[int, Primitives, NDArray[np.float64]]]:
        shared: dict[int, Primitives] = {}
        for primitive in mesh["primitives"]:
            place = primitive.get("attributes", {}).get("POSITION")
            if place is None:
                raise InvalidInput("a primitive has no positions")
            shared.setdefault(place, []).append(primitive)
        self._primitives += len(mesh["primitives"])
        require_parts(self._primitives)
        for place, primitives in shared.items():
            yield place, primitives, matrix

    def _made(self, place: int, primitives: Primitives) -> tuple[NDArray[Any], NDArray[np.int64]]:
        points = self._accessor(place, "VEC3")
        return points, np.concatenate([self._faces(each, len(points)) for each in primitives])

    def _most_faces(self, primitive: dict[str, Any], count: int) -> int:
        mode = primitive.get("mode", _TRIANGLES)
        if mode not in (_TRIANGLES, _STRIP, _FAN):  # points and lines
            return 0
        if "indices" in primitive:
            count = len(self.stored(primitive["indices"], "SCALAR"))
        return count // 3 if mode == _TRIANGLES else max(count - 2, 0)

    def _faces(self, primitive: dict[str, Any], count: int) -> NDArray[np.int64]:
        mode = primitive.get("mode", _TRIANGLES)
        if self._most_faces(primitive, count) == 0:
            return np.empty((0, 3), np.int64)
        corners = (
            self._accessor(primitive["indices"], "SCALAR").astype(np.int64)
            if "indices" in primitive
            else np.arange(count)
        )
        if corners.max() >= count:
            raise InvalidInput(f"a face names point {corners.max()}; there are {count} points")
        if mode == _STRIP:
            return strips(corners)
        if mode == _FAN:
            first = np.full(len(corners) - 2, corners[0])
            return np.column_stack([first, corners[1:-1], corners[2:]])
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)

    def stored(self, number: int, kind: str) -> NDArray[Any]:
        """The values (n, k) of an accessor as they lie in their buffer."""
        accessor = self._tree["accessors"][number]
        if accessor["type"] != kind:
            raise InvalidInput(f"an accessor has the type {accessor['type']}; allowed is {kind}")
        if "bufferView" not in accessor:
            raise InvalidInput("an accessor has no data")
        shape = (accessor["count"], _COMPONENTS[kind])
        type_ = np.dtype(_TYPES[accessor["componentType"]])
        return self._view(accessor["bufferView"], accessor.get("byteOffset", 0), type_, shape)

    def _accessor(self, number: int, kind: str) -> NDArray[Any]:
        accessor = self._tree["accessors"][number]
        values = self.stored(number, kind)
        type_ = values.dtype
        if (sparse := accessor.get("sparse")) is not None:
            values = np.array(values)
            at, new = sparse["indices"], sparse["values"]
            rows = self._view(
                at["bufferView"],
                at.get("byteOffset", 0),
                np.dtype(_TYPES[at["componentType"]]),
                (sparse["count"], 1),
            )
            values[rows[:, 0].astype(np.int64)] = self._view(
                new["bufferView"],
                new.get("byteOffset", 0),
                type_,
                (sparse["count"], values.shape[1]),
            )
        if accessor.get("normalized") and type_.kind != "f":
            values = np.maximum(values / np.iinfo(type_).max, -1)
        return values if kind == "VEC3" else values[:, 0]

    def _view(
        self, number: int, offset: int, type_: np.dtype[Any], shape: tuple[int, int]
    ) -> NDArray[Any]:
        view = self._tree["bufferViews"][number]
        start = view.get("byteOffset", 0)
        content = memoryview(self._buffer(view["buffer"]))[start : start + view["byteLength"]]
        size = type_.itemsize * shape[1]
        stride = view.get("byteStride") or size
        needed = offset + stride * (shape[0] - 1) + size if shape[0] else 0
        if not 0 <= needed <= len(content) or offset < 0 or stride < size:
            raise InvalidInput(
                f"the file is truncated: {shape[0]} values take {needed} bytes, there are "
                f"{len(content)}"
            )
        return np.ndarray(shape, type_, content, offset, (stride, type_.itemsize))

    def _buffer(self, number: int) -> bytes | bytearray:
        if number not in self._buffers:
            buffer = self._tree["buffers"][number]
            uri = buffer.get("uri")
            if uri is None:
                if self._binary is None:
                    raise InvalidInput(f"buffer {number} has no data")
                content: bytes | bytearray = self._binary
            elif uri.startswith("data:"):
                content = base64.b64decode(uri.partition(",")[2])
            elif ":" in uri:
                raise InvalidInput(f"buffer {number} is at {uri!r:.60}, which is no file beside it")
            elif self._path is None or self._reading is None:
                raise InvalidInput(f"buffer {number} is in another file")
            else:
                content = self._file(referenced(unquote(uri), self._path, self._reading))
            if len(content) < buffer["byteLength"]:
                raise InvalidInput(
                    f"the file is truncated: buffer {number} has {len(content)} bytes of "
                    f"{buffer['byteLength']}"
                )
            self._buffers[number] = content
        return self._buffers[number]

    def _file(self, file: Path) -> bytes:
        """What a file holds that buffers name, of which each is read once."""
        if file not in self._files:
            require_memory(file.stat().st_size + sum(map(len, self._files.values())))
            self._files[file] = file.read_bytes()
        return self._files[file]


def _matrix(node: dict[str, Any]) -> NDArray[np.float64]:
    """From the node to what is above it."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.array(node.get("scale", (1, 1, 1)), dtype=float)
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix
