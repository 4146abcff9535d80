"""Formats of text, and those of them that have a binary kind."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence

from . import FACES, NORMALS, POINTS, QUAD

_POLYGONS = [QUAD, *map(tuple, FACES[2:].tolist())]
_STRIP = (3, 2, 0, 1)  # the triangles of the quadrangle, as a strip
_FORMATS = {"<": "binary_little_endian", ">": "binary_big_endian"}
_CODES = {"float": "f", "double": "d", "uchar": "B", "int": "i", "uint": "I", "short": "h"}


def _row(values: Sequence[object], joint: str = " ") -> str:
    return joint.join(f"{value:g}" if isinstance(value, float) else str(value) for value in values)


def ply(
    order: str = "",
    real: str = "float",
    named: str = "vertex_indices",
    length: str = "uchar",
    index: str = "int",
    extra: Sequence[str] = (),
    head: str = "",
    strips: bool = False,
    polygons: Sequence[Sequence[int]] = (),
    element: str = "face",
    end: str = "\n",
) -> bytes:
    faces = list(polygons) or (FACES[2:].tolist() if strips else FACES.tolist())
    lines = ["ply", f"format {_FORMATS.get(order, 'ascii')} 1.0", *filter(None, [head])]
    lines += [f"element vertex {len(POINTS)}", *(f"property {real} {axis}" for axis in "xyz")]
    lines += [f"property uchar {name}" for name in extra]
    if strips:
        lines += ["element tristrips 1", "property list int int vertex_indices"]
    lines += [f"element {element} {len(faces)}", f"property list {length} {index} {named}"]
    lines.append("end_header")
    header = end.join([*lines, ""]).encode()
    if not order:
        rows = [_row([*point, *[7] * len(extra)]) for point in POINTS.tolist()]
        rows += [_row([len(_STRIP) + 1, *_STRIP, -1])] if strips else []
        rows += [_row([len(face), *face]) for face in faces]
        return header + end.join([*rows, ""]).encode()
    body = b"".join(
        struct.pack(f"{order}3{_CODES[real]}{len(extra)}B", *point, *[7] * len(extra))
        for point in POINTS
    )
    body += struct.pack(f"{order}6i", 5, *_STRIP, -1) if strips else b""
    for face in faces:
        kinds = f"{order}{_CODES[length]}{len(face)}{_CODES[index]}"
        body += struct.pack(kinds, len(face), *face)
    return header + body


_PLAIN = ply()
PLY = {
    "text": _PLAIN,
    "text of Windows": ply(end="\r\n"),
    "text of an old Mac": ply(end="\r"),
    "little": ply("<"),
    "big": ply(">"),
    "doubles": ply("<", "double"),
    "unsigned indices, as of Blender": ply("<", index="uint"),
    "vertex_index, as of MeshLab's older files": ply("<", named="vertex_index"),
    "long lists": ply(">", length="int"),
    "colours": ply("<", extra=("red", "green", "blue", "alpha")),
    "colours in text": ply(extra=("red", "green", "blue")),
    "polygons": ply(polygons=_POLYGONS),
    "polygons in binary": ply("<", polygons=_POLYGONS, index="uint"),
    "strips": ply(strips=True),
    "strips in binary": ply("<", strips=True),
    "strips, big": ply(">", strips=True),
    "comments": ply(head="comment Created by hand\nobj_info scanned"),
    "another name of the faces": ply(element="polygon"),
    "edges beside faces": ply(polygons=[*FACES.tolist(), (0, 1)]),
    "rows over lines": _PLAIN.replace(b"\n4 0 0.25\n", b"\n4\n0 0.25\n"),
    "longer rows than the header names": _PLAIN.replace(b"\n4 0 0.25\n", b"\n4 0 0.25 0 0 1\n"),
    "blanks at the ends": _PLAIN.replace(b"\n", b"  \n"),
}


def obj(
    corner: Callable[[int], str] = str,
    polygons: Sequence[Sequence[int]] = (),
    rest: str = "",
    head: str = "",
    end: str = "\n",
    back: bool = False,
    behind: str = "",
) -> bytes:
    faces = list(polygons) or FACES.tolist()
    lines = [*filter(None, [head]), *(f"v {_row(point)}{rest}" for point in POINTS.tolist())]
    lines += ["vt 0 0", *(f"vn {_row(normal)}" for normal in NORMALS.tolist())]
    first = -len(POINTS) if back else 1
    lines += [f"f {' '.join(corner(c + first) for c in face)}{behind}" for face in faces]
    return end.join([*lines, ""]).encode()


_OBJ = obj()
OBJ = {
    "plain": _OBJ,
    "of Windows": obj(end="\r\n"),
    "of an old Mac": obj(end="\r"),
    "with a byte order mark": b"\xef\xbb\xbf" + _OBJ,
    "texture": obj(lambda c: f"{c}/1"),
    "normals": obj(lambda c: f"{c}//{c}"),
    "texture and normals": obj(lambda c: f"{c}/1/{c}"),
    "slashes without a number": obj(lambda c: f"{c}/"),
    "counted backwards": obj(back=True),
    "backwards with normals": obj(lambda c: f"{c}//{c}", back=True),
    "polygons": obj(polygons=_POLYGONS),
    "colours": obj(rest=" 0.5 0.25 1"),
    "weights": obj(rest=" 1.0"),
    "materials and groups": obj(head="mtllib a.mtl\no thing\ng part\nusemtl red\ns 1"),
    "comments behind faces": obj(behind=" # a face"),
    "comments behind points": obj(rest=" # a point"),
    "comments without a blank": obj(rest="# a point", behind="# a face"),
    "lines that go on": _OBJ.replace(b"v 4 0 0.25", b"v 4 \\\n0 0.25").replace(
        b"f 1 6 2\n", b"f 1 \\\n6 2\n"
    ),
    "lines that go on without a blank": _OBJ.replace(b"f 1 2 6\n", b"f 1 2\\\n6\n"),
    "edges and points": obj(polygons=[*FACES.tolist(), (0, 1), (2,)], behind="") + b"l 1 2\np 3\n",
    "tabs": _OBJ.replace(b" ", b"\t"),
    "faces first": b"".join(sorted(_OBJ.splitlines(keepends=True), key=lambda line: line[:1])),
}


def off(
    start: str = "OFF\n{} {} 0",
    rest: str = "",
    polygons: Sequence[Sequence[int]] = (),
    behind: str = "",
    end: str = "\n",
) -> bytes:
    faces = list(polygons) or FACES.tolist()
    lines = [start.format(len(POINTS), len(faces))]
    lines += [f"{_row(point)}{rest}" for point in POINTS.tolist()]
    lines += [f"{_row([len(face), *face])}{behind}" for face in faces]
    return end.join([*lines, ""]).encode()


_OFF = off()
OFF = {
    "plain": _OFF,
    "of Windows": off(end="\r\n"),
    "of an old Mac": off(end="\r").replace(b"\n", b"\r"),
    "glued, as in ModelNet": off("OFF{} {} 0"),
    "counts behind the keyword": off("OFF {} {} 0"),
    "without the keyword": off("{} {} 0"),
    "without the edges": off("OFF\n{} {}"),
    "small letters": off("off\n{} {} 0"),
    "blank lines": off("OFF\n\n{} {} 0\n"),
    "comments": off("# by hand\nOFF\n# counts\n{} {} 0"),
    "comments behind data": off(rest=" # a point", behind=" # a face"),
    "colours of points": off("COFF\n{} {} 0", " 255 0 0 255"),
    "colours of points without a keyword": off(rest=" 255 0 0"),
    "normals": off("NOFF\n{} {} 0", " 0 0.6 0.8"),
    "normals and colours": off("CNOFF\n{} {} 0", " 0 0.6 0.8 255 0 0 255"),
    "texture": off("STOFF\n{} {} 0", " 0.5 0.5"),
    "colours of faces": off(behind=" 255 0 0"),
    "colours of faces as one number": off(behind=" 7"),
    "polygons": off(polygons=_POLYGONS),
    "numbers in one line": b" ".join(_OFF.split()),
    "a number a line": b"\n".join(_OFF.split()),
    "points over lines, as of libigl": _OFF.replace(b"4 0 0.25\n", b"4\n0\n0.25\n"),
}


def stl(head: str = "solid a", indent: str = "", number: str = "{:g}", end: str = "\n") -> bytes:
    lines = [head]
    for face in POINTS[FACES].tolist():
        lines += ["facet normal 0 0 1", f"{indent}outer loop"]
        lines += [
            f"{indent * 2}vertex {' '.join(number.format(x) for x in corner)}" for corner in face
        ]
        lines += [f"{indent}endloop", "endfacet"]
    return end.join([*lines, f"end{head.strip()}", ""]).encode()


def binary_stl(head: bytes = b"made", attribute: int = 0, behind: bytes = b"") -> bytes:
    body = b"".join(
        struct.pack("<12fH", 0, 0, 1, *face.ravel(), attribute) for face in POINTS[FACES]
    )
    return head.ljust(80, b" ") + struct.pack("<I", len(FACES)) + body + behind


STL = {
    "text": stl(),
    "capitals": stl().upper(),
    "mixed": stl().replace(b"facet", b"Facet").replace(b"vertex", b"Vertex"),
    "of Windows": stl(end="\r\n"),
    "of an old Mac": stl(end="\r"),
    "indented": stl(indent="  "),
    "tabs": stl(indent="\t"),
    "exponents": stl(number="{:.10e}"),
    "exponents in capitals": stl(number="{:.10E}"),
    "plus signs": stl(number="{:+.6f}"),
    "no name": stl("solid"),
    "a long name": stl("solid part 7 of facet normal 0 0 1"),
    "blank lines": stl(end="\n\n"),
    "blanks first": b"\n  " + stl(),
    "several solids": stl().replace(b"endfacet\n", b"endfacet\nendsolid a\nsolid b\n", 1),
    "binary": binary_stl(),
    "binary that starts with solid": binary_stl(b"solid thing"),
    "binary with colours": binary_stl(b"COLOR=\xff\x00\x00\xff", 0x8123),
    "binary with more behind": binary_stl(behind=b"\0\0"),
    "binary solid with more behind": binary_stl(b"solid", behind=b"\0" * 99),
    "binary with zeros": binary_stl(b"\0" * 80),
}


def table(
    joint: str = ",",
    names: str | None = "x,y,z",
    before: str = "",
    ids: str | None = None,
    behind: str = "",
    decimal: str = ".",
    end: str = "\n",
) -> bytes:
    lines = [before] if before else []
    lines += [names.replace(",", joint)] if names is not None else []
    for number, point in enumerate(POINTS.tolist(), 1):
        cells = [f"{x:g}".replace(".", decimal) for x in point]
        lines.append(joint.join([*([ids.format(number)] if ids else []), *cells]) + behind)
    return end.join([*lines, ""]).encode()


TABLE = {
    "names": table(),
    "of Windows": table(end="\r\n"),
    "of an old Mac": table(end="\r"),
    "with a byte order mark": b"\xef\xbb\xbf" + table(),
    "no names": table(names=None),
    "blanks": table(" ", None),
    "tabs": table("\t", "X,Y,Z"),
    "semicolons": table(";", "X,Y,Z"),
    "decimal commas, as of a German Excel": table(";", "X,Y,Z", decimal=","),
    "decimal commas between tabs": table("\t", None, decimal=","),
    "decimal commas between blanks": table(" ", None, decimal=","),
    "units": table(names="X [mm],Y [mm],Z [mm]"),
    "units between blanks": table(" ", "X (m),Y (m),Z (m)"),
    "ParaView": table(names="Points:0,Points:1,Points:2"),
    "ParaView, later": table(names="id,Points_0,Points_1,Points_2", ids="{}"),
    "pandas": table(names=",x,y,z", ids="{}"),
    "R": table(names='"x","y","z"', ids='"{}"'),
    "quoted commas": table(names="label,x,y,z", ids='"left, {}"'),
    "a comment of names, as of NumPy": table(" ", None, "# x y z"),
    "CloudCompare": table(" ", None, "//X Y Z R G B", behind=" 9 9 9"),
    "a count first, as of PTS": table(" ", None, "6", behind=" 1 2 3 4"),
    "chemists": table(" ", None, "6\nwater, twice", ids="C{}"),
    "3D Slicer": table(
        ",", None, "# CoordinateSystem = LPS\n# columns = id,x,y,z,ow,label", "F_{}", ",0,"
    ),
    "an empty last cell": table(names="x,y,z,note", behind=","),
}
