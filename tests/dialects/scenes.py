"""Scenes: glTF and 3MF."""

from __future__ import annotations

import base64
import io
import json
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from . import FACES, POINTS


def gltf(
    points: Any = POINTS,
    indices: Any = FACES,
    index: str = "<u2",
    coordinate: str = "<f4",
    stride: int = 0,
    mode: int | None = None,
    node: dict[str, Any] | None = None,
    change: Callable[[dict[str, Any]], object] = lambda tree: None,
    binary: bool = False,
) -> bytes:
    kinds = {"<i1": 5120, "<u1": 5121, "<i2": 5122, "<u2": 5123, "<u4": 5125, "<f4": 5126}
    rows = np.asarray(points).astype(coordinate)
    packed = b"".join(row.tobytes().ljust(stride, b"\0") for row in rows)
    packed += b"\0" * (-len(packed) % 4)
    corners = b"" if indices is None else np.asarray(indices).astype(index).tobytes()
    data = packed + corners
    primitive: dict[str, Any] = {"attributes": {"POSITION": 0}}
    if mode is not None:
        primitive["mode"] = mode
    tree: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, **(node or {})}],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": kinds[coordinate],
                "count": len(rows),
                "type": "VEC3",
            }
        ],
        "bufferViews": [{"buffer": 0, "byteLength": len(packed)}],
        "buffers": [{"byteLength": len(data)}],
    }
    if stride:
        tree["bufferViews"][0]["byteStride"] = stride
    if indices is not None:
        primitive["indices"] = 1
        tree["accessors"].append(
            {
                "bufferView": 1,
                "componentType": kinds[index],
                "count": np.size(indices),
                "type": "SCALAR",
            }
        )
        view = {"buffer": 0, "byteOffset": len(packed), "byteLength": len(corners)}
        tree["bufferViews"].append(view)
    if not binary:
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        tree["buffers"][0]["uri"] = uri
    change(tree)
    text = json.dumps(tree).encode()
    if not binary:
        return text
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _beside(path: Path) -> None:
    tree = json.loads(gltf())
    content = base64.b64decode(tree["buffers"][0]["uri"].partition(",")[2])
    tree["buffers"][0]["uri"] = "shape%20data.bin"
    path.with_name("shape data.bin").write_bytes(content)
    path.write_text(json.dumps(tree))


def _sparse(tree: dict[str, Any]) -> None:
    """The last point, which the view has as nothing, comes from elsewhere."""
    more = np.array([5], "<u2").tobytes() + b"\0\0" + POINTS[5].astype("<f4").tobytes()
    tree["buffers"].append(
        {
            "byteLength": len(more),
            "uri": "data:;base64," + base64.b64encode(more).decode(),
        }
    )
    tree["bufferViews"] += [
        {"buffer": 1, "byteLength": 2},
        {"buffer": 1, "byteOffset": 4, "byteLength": 12},
    ]
    tree["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": 2, "componentType": 5123},
        "values": {"bufferView": 3},
    }


def _two_primitives(tree: dict[str, Any]) -> None:
    first = tree["meshes"][0]["primitives"][0]
    tree["accessors"][1]["count"] = 9
    tree["accessors"].append({**tree["accessors"][1], "byteOffset": 18, "count": 12})
    tree["meshes"][0]["primitives"].append({**first, "indices": 2})


def _child(tree: dict[str, Any]) -> None:
    tree["nodes"] = [
        {"children": [1], "translation": [1, 2, 3]},
        {"mesh": 0, "translation": [-1, -2, -3]},
    ]


def _extension(tree: dict[str, Any], name: str, required: bool) -> None:
    tree["extensionsUsed"] = [name]
    if required:
        tree["extensionsRequired"] = [name]


def _fan(tree: dict[str, Any]) -> None:
    """The first two triangles as a fan around point 0, wound as they are."""
    fan = np.array([0, 3, 2, 1], "<u2").tobytes()
    tree["buffers"].append(
        {"byteLength": 8, "uri": "data:;base64," + base64.b64encode(fan).decode()}
    )
    tree["bufferViews"].append({"buffer": 1, "byteLength": 8})
    tree["accessors"][1].update(byteOffset=12, count=15)
    tree["accessors"].append({"bufferView": 2, "componentType": 5123, "count": 4, "type": "SCALAR"})
    first = tree["meshes"][0]["primitives"][0]
    tree["meshes"][0]["primitives"].append({**first, "indices": 2, "mode": 6})


def _strip_of_two(tree: dict[str, Any]) -> None:
    _fan(tree)
    strip = np.array([3, 2, 0, 1], "<u2").tobytes()
    tree["buffers"][1]["uri"] = "data:;base64," + base64.b64encode(strip).decode()
    tree["meshes"][0]["primitives"][1]["mode"] = 5


_SMALL = 4 * POINTS  # whole numbers
_QUARTER = np.diag([0.25, 0.25, 0.25, 1]).T.ravel().tolist()
_SOUP = POINTS[FACES].reshape(-1, 3)
GLTF: dict[str, Any] = {
    "embedded": gltf(),
    "beside": _beside,
    "binary": (".glb", gltf(binary=True)),
    "long indices": gltf(index="<u4"),
    "short indices": gltf(index="<u1"),
    "without indices": gltf(_SOUP, None),
    "triangles by their mode": gltf(mode=4),
    "with a stride": gltf(stride=24),
    "points": gltf(indices=None, mode=0),
    "sparse": gltf(np.vstack([POINTS[:5], [(0, 0, 0)]]), change=_sparse),
    "two primitives": gltf(change=_two_primitives),
    "a fan": gltf(change=_fan),
    "a strip": gltf(change=_strip_of_two),
    "translated": gltf(POINTS - (1, 2, 3), node={"translation": [1, 2, 3]}),
    "scaled": gltf(_SMALL, node={"scale": [0.25, 0.25, 0.25]}),
    "rotated": gltf(POINTS * (-1, -1, 1), node={"rotation": [0, 0, 1, 0]}),
    "a matrix": gltf(_SMALL, node={"matrix": _QUARTER}),
    "mirrored": gltf(POINTS * (-1, 1, 1), FACES[:, ::-1], node={"scale": [-1, 1, 1]}),
    "a child": gltf(change=_child),
    "small integers": gltf(
        _SMALL,
        coordinate="<i1",
        stride=4,
        node={"scale": [0.25] * 3},
        change=lambda tree: _extension(tree, "KHR_mesh_quantization", True),
    ),
    "normalised integers": gltf(
        4 * POINTS,
        coordinate="<i2",
        stride=8,
        node={"scale": [32767 / 4] * 3},
        change=lambda tree: tree["accessors"][0].update(normalized=True),
    ),
    "materials": gltf(change=lambda tree: _extension(tree, "KHR_materials_unlit", True)),
    "compressed or not": gltf(
        change=lambda tree: _extension(tree, "KHR_draco_mesh_compression", False)
    ),
    "no scene": gltf(change=lambda tree: [tree.pop("scenes"), tree.pop("scene")]),
    "with a byte order mark": b"\xef\xbb\xbf" + gltf(),
}
REFUSED_GLTF = {
    gltf(change=lambda tree, name=name: _extension(tree, name, True)): name
    for name in ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "VENDOR_any")
} | {
    gltf(change=lambda tree: tree["accessors"][0].pop("bufferView")): "no data",
    gltf(change=lambda tree: tree["accessors"][0].update(count=9_000_000_000)): "truncated",
    gltf(change=lambda tree: tree["buffers"][0].update(byteLength=10**12)): "truncated",
    gltf(
        change=lambda tree: tree["accessors"].__setitem__(
            0, {"componentType": 5126, "count": 2 * 10**9, "type": "VEC3", "sparse": {"count": 0}}
        )
    ): "no data",
    gltf(change=lambda tree: tree["buffers"][0].update(uri="none.bin")): "none.bin",
    gltf(change=lambda tree: tree["asset"].update(version="1.0")): "version is 1.0",
    gltf(change=lambda tree: tree["nodes"][0].update(children=[0])): "stands in the scene twice",
    gltf(indices=FACES + 1): "names point 6",
}

_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
_TYPE = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"


def mesh(
    points: Any = POINTS, faces: Any = FACES, number: int = 1, attributes: str = "", rest: str = ""
) -> str:
    vertices = "".join(f'<vertex x="{x:g}" y="{y:g}" z="{z:g}"/>' for x, y, z in points)
    triangles = "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}"{rest}/>' for a, b, c in np.asarray(faces)
    )
    return (
        f'<object id="{number}" type="model"{attributes}><mesh><vertices>{vertices}</vertices>'
        f"<triangles>{triangles}</triangles></mesh></object>"
    )


def model(resources: str, items: str = '<item objectid="1"/>', attributes: str = "") -> str:
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<model unit="millimeter" xmlns="{_CORE}" '
        f'xmlns:p="{_PRODUCTION}"{attributes}><resources>{resources}</resources>'
        f"<build>{items}</build></model>"
    )


def archive(
    files: dict[str, str],
    root: str | None = "/3D/3dmodel.model",
    packing: int = zipfile.ZIP_DEFLATED,
) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", packing) as file:
        if root is not None:
            file.writestr(
                "_rels/.rels",
                '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                f'<Relationship Target="{root}" Id="rel0" Type="{_TYPE}"/></Relationships>',
            )
        for name, content in files.items():
            file.writestr(name, content)
    return made.getvalue()


def simple(*given: Any, **named: Any) -> bytes:
    return archive({"3D/3dmodel.model": model(*given, **named)})


_PART = '<object id="2" type="model"><components><component objectid="1"{}/></components></object>'
_MOVE = ' transform="1 0 0 0 1 0 0 0 1 1 2 3"'
_HERE = model(mesh(), "")
_THERE = '<object id="8"><components><component p:path="/3D/Objects/a.model" objectid="1"/></components></object>'
_BAMBU = {
    "3D/3dmodel.model": model(_THERE, '<item objectid="8" p:UUID="1"/>', ' requiredextensions="p"'),
    "3D/Objects/a.model": _HERE,
}
THREE_MF: dict[str, Any] = {
    "plain": simple(mesh()),
    "stored": archive({"3D/3dmodel.model": model(mesh())}, packing=zipfile.ZIP_STORED),
    "no relationships": archive({"3D/3dmodel.model": model(mesh())}, None),
    "another name": archive({"3D/a.model": model(mesh())}, "/3D/a.model"),
    "a relative target": archive({"3D/a.model": model(mesh())}, "3D/a.model"),
    "capitals": archive({"3d/3DModel.model": model(mesh())}, None),
    "moved": simple(mesh(POINTS - (1, 2, 3)), f'<item objectid="1"{_MOVE}/>'),
    "scaled": simple(
        mesh(4 * POINTS), '<item objectid="1" transform="0.25 0 0 0 0.25 0 0 0 0.25 0 0 0"/>'
    ),
    "turned": simple(
        mesh(POINTS @ [[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
        '<item objectid="1" transform="0 1 0 -1 0 0 0 0 1 0 0 0"/>',
    ),
    "mirrored": simple(
        mesh(POINTS * (-1, 1, 1), FACES[:, ::-1]),
        '<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>',
    ),
    "a component": simple(mesh() + _PART.format(""), '<item objectid="2"/>'),
    "a moved component": simple(
        mesh(POINTS - (1, 2, 3)) + _PART.format(_MOVE), '<item objectid="2"/>'
    ),
    "a component before its mesh": simple(_PART.format("") + mesh(), '<item objectid="2"/>'),
    "two items": simple(
        mesh(faces=FACES[:3]) + mesh(faces=FACES[3:], number=2),
        '<item objectid="1"/><item objectid="2"/>',
    ),
    "what is not built": simple(mesh() + mesh(POINTS + 9, number=2)),
    "production parts": archive(_BAMBU),
    "an item elsewhere": archive(
        {
            "3D/3dmodel.model": model("", '<item objectid="1" p:path="/3D/Objects/a.model"/>'),
            "3D/Objects/a.model": _HERE,
        }
    ),
    "one number in two files": archive(
        {
            "3D/3dmodel.model": model(
                mesh(faces=FACES[:3]),
                '<item objectid="1"/><item objectid="1" p:path="/3D/a.model"/>',
            ),
            "3D/a.model": model(mesh(faces=FACES[3:]), ""),
        }
    ),
    "materials": simple(
        '<basematerials id="5"><base name="a" displaycolor="#FF0000"/></basematerials>'
        + mesh(attributes=' pid="5" pindex="0"', rest=' pid="5" p1="0"')
    ),
    "a prefix for all": archive(
        {
            "3D/3dmodel.model": model(mesh())
            .replace(f'xmlns="{_CORE}"', f'xmlns:c="{_CORE}"')
            .replace("</", "\0")
            .replace("<?", "\1")
            .replace("<", "<c:")
            .replace("\0", "</c:")
            .replace("\1", "<?")
        }
    ),
    "metadata": simple(
        '<metadata name="x">y</metadata>' + mesh(attributes=' name="a" partnumber="7"')
    ),
    "other files beside": archive({"3D/3dmodel.model": model(mesh()), "Metadata/a.png": "png"}),
}
_DOUBLED = "".join(
    f'<object id="{i + 1}"><components><component objectid="{i}"/><component objectid="{i}"/>'
    "</components></object>"
    for i in range(1, 40)
)
REFUSED_THREE_MF = {
    simple(mesh() + _DOUBLED, '<item objectid="40"/>'): "more than 100000 parts",
    simple(mesh(), attributes=' requiredextensions="s" xmlns:s="http://a.b/slice"'): "a.b/slice",
    simple(_PART.format("").replace('"1"', '"2"'), '<item objectid="2"/>'): "part of itself",
    simple(mesh(), '<item objectid="7"/>'): "no object 7",
    archive({"3D/other.model": model(mesh())}): "no file 3D/3dmodel.model",
    simple(mesh(faces=FACES + 1)): "names point 6",
}
