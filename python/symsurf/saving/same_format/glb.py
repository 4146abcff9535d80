"""GLB: positions, normals, tangents and morph targets are written over those of the file; materials,
textures, animations and all else stay as they are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...shapes.columns import columns_of
from ..glb_format import glb_bytes
from .new_shape import LOST_NORMALS, NewShape, Rewritten

if TYPE_CHECKING:
    from ...reading.gltf import Primitives, Scene

_FLOAT = 5126
_DIRECTIONS = {"NORMAL": ("VEC3", "normal"), "TANGENT": ("VEC4", "vector")}


def rewritten_glb(content: bytes, new: NewShape) -> Rewritten:
    """Raises ValueError for points that are not the file's, and for a file that does not hold them as
    floats in its own buffer, each once."""
    from ...reading.gltf import tree_and_binary  # `import symsurf` does not wait for json

    tree, binary = tree_and_binary(content)
    if binary is None or new.adds_points or new.carried is not None or len(tree["buffers"]) > 1:
        raise ValueError
    return _Rewriting(tree, binary, new).done()


class _Rewriting:
    def __init__(self, tree: dict[str, Any], binary: bytes, new: NewShape) -> None:
        self._tree, self._binary, self._new = tree, bytearray(binary), new
        self._more = bytearray()  # behind the binary, which does not grow while it is looked into
        self._seen: dict[int, int] = {}  # the accessor of the points, by that of what they have
        self._lost: set[str] = set()

    def done(self) -> Rewritten:
        from ...reading.gltf import Scene

        scene = Scene(self._tree, self._binary)
        added: list[tuple[Primitives, slice]] = []
        first = 0
        for place, primitives, matrix in scene.groups():
            points = self._floats(scene, place, place, "VEC3")
            rows = slice(first, first + len(points))
            first += len(points)
            back = np.linalg.inv(matrix)
            if self._new.moved:
                self._carry(scene, place, primitives, rows, matrix[:3, :3])
                points[:] = self._new.points[rows] @ back[:3, :3].T + back[:3, 3]
                self._limit(place, points)
            added.append((primitives, rows))
        for name, values in columns_of(self._new.arrays).items():
            for primitives, rows in added:
                number = self._appended(values[rows].astype("<f4"))
                for primitive in primitives:
                    primitive["attributes"][f"_{name.upper()}"] = number
        whole = bytes(self._binary + self._more)
        self._tree["buffers"][0]["byteLength"] = len(whole)
        return Rewritten(glb_bytes(self._tree, whole), sorted(self._lost))

    def _floats(self, scene: Scene, number: int, place: int, kind: str) -> NDArray[Any]:
        """Those of an accessor, to be written over."""
        accessor = self._tree["accessors"][number]
        if accessor["componentType"] != _FLOAT or "sparse" in accessor or number in self._seen:
            raise ValueError
        self._seen[number] = place
        return scene.stored(number, kind)

    def _carry(
        self,
        scene: Scene,
        place: int,
        primitives: Primitives,
        rows: slice,
        linear: NDArray[np.float64],
    ) -> None:
        """Normals, tangents, and how far morph targets move points and turn normals. ``linear``: from
        the node to the scene."""
        for primitive in primitives:
            attributes = primitive["attributes"]
            for name, (kind, rule) in _DIRECTIONS.items():
                number = attributes.get(name)
                if number is None or self._seen.get(number) == place:
                    continue
                if self._new.directed is None:
                    del attributes[name]
                    self._lost.add(LOST_NORMALS)
                    continue
                values = self._floats(scene, number, place, kind)
                made = self._moved(values[:, :3], rule, rows, linear)
                lengths = np.linalg.norm(made, axis=1, keepdims=True)
                values[:, :3] = made / np.where(lengths > 0, lengths, 1)
            for target in primitive.get("targets", []):
                if target.keys() - {"POSITION"} or self._new.directed is None:
                    raise ValueError
                number = target.get("POSITION")
                if number is not None and self._seen.get(number) != place:
                    values = self._floats(scene, number, place, "VEC3")
                    values[:] = self._moved(values, "vector", rows, linear)
                    self._limit(number, values)

    def _moved(
        self, values: NDArray[Any], rule: str, rows: slice, linear: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        assert self._new.directed is not None
        there = linear if rule == "vector" else np.linalg.inv(linear).T
        whole = np.zeros((len(self._new.points), 3))
        whole[rows] = values @ there.T
        return self._new.directed(whole, rule, rule)[rows] @ np.linalg.inv(there).T

    def _limit(self, number: int, values: NDArray[Any]) -> None:
        accessor = self._tree["accessors"][number]
        accessor["min"], accessor["max"] = values.min(axis=0).tolist(), values.max(axis=0).tolist()

    def _appended(self, values: NDArray[Any]) -> int:
        """The number of a new accessor, at a multiple of 4 bytes."""
        first = len(self._binary) + len(self._more)
        self._more += b"\0" * (-first % 4) + values.tobytes()
        view = {"buffer": 0, "byteOffset": first + -first % 4, "byteLength": values.nbytes}
        self._tree["bufferViews"].append(view)
        accessor = {"componentType": _FLOAT, "count": len(values), "type": "SCALAR"}
        self._tree["accessors"].append(
            {"bufferView": len(self._tree["bufferViews"]) - 1, **accessor}
        )
        return len(self._tree["accessors"]) - 1
