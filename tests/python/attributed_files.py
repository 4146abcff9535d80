"""Files of a mesh with attributes that symsurf knows nothing of, in each format that is rewritten."""

from __future__ import annotations

import struct


def text(values):
    return " ".join(repr(value) if isinstance(value, float) else str(value) for value in values)


def ply_text(points, faces, normals):
    rows = [
        text([*p, i, 10 * i, *n]) for i, (p, n) in enumerate(zip(points.tolist(), normals.tolist()))
    ]
    polygons = [text([len(face), *face, i]) for i, face in enumerate(faces)]
    header = f"""ply
format ascii 1.0
comment SPACE=LPS
obj_info made by hand
element vertex {len(points)}
property double x
property double y
property double z
property uchar red
property float heat
property float nx
property float ny
property float nz
element face {len(faces)}
property list uchar int vertex_indices
property short part
element edge 1
property int vertex1
end_header
"""
    return (header + "\n".join([*rows, *polygons, "7"]) + "\n").encode()


def ply_binary(points, faces, normals, order):
    content = ply_text(points, faces, normals)
    header = content[: content.index(b"end_header\n") + 11]
    name = {"<": b"binary_little_endian", ">": b"binary_big_endian"}[order]
    body = b"".join(
        struct.pack(order + "3dBf3f", *p, i, 10 * i, *n)
        for i, (p, n) in enumerate(zip(points, normals))
    )
    for i, face in enumerate(faces):
        body += struct.pack(f"{order}B{len(face)}ih", len(face), *face, i)
    return header.replace(b"ascii", name) + body + struct.pack(order + "i", 7)


def obj(points, faces, normals):
    lines = ["# 3D Slicer output. SPACE=LPS", "mtllib box.mtl", "o box"]
    lines += [text(["v", *p, 0.5, 0.25, i / 16]) for i, p in enumerate(points.tolist())]
    lines += ["vt 0.5 0.25", *(text(["vn", *n]) for n in normals.tolist()), "usemtl red", "s off"]
    lines += [text(["f", *(f"{c + 1}/1/{c + 1}" for c in face)]) for face in faces]
    return ("\n".join(lines) + "\n").encode()


def off(points, faces, normals):
    rows = [
        text([*p, *n, i, 0, 255, 255])
        for i, (p, n) in enumerate(zip(points.tolist(), normals.tolist()))
    ]
    polygons = [text([len(face), *face, 255, 0, 0]) for face in faces]
    return (
        "\n".join(["CNOFF # SPACE", f"{len(points)} {len(faces)} 0", *rows, *polygons, ""])
        .replace(" # SPACE", "")
        .encode()
    )


def csv_text(points, faces, normals):
    rows = [
        ",".join(map(repr, [i, *p, *n]))
        for i, (p, n) in enumerate(zip(points.tolist(), normals.tolist()))
    ]
    return "\n".join(["# SPACE=LPS", "id,x,y,z,nx,ny,nz", *rows, ""]).encode()


def stl(points, faces, is_text):
    triangles = [[f[0], f[i], f[i + 1]] for f in faces for i in range(1, len(f) - 1)]
    if is_text:
        lines = ["solid box SPACE=LPS"]
        for triangle in triangles:
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += [text(["vertex", *points[corner].tolist()]) for corner in triangle]
            lines += ["endloop", "endfacet"]
        return "\n".join([*lines, "endsolid box", ""]).encode()
    content = b"3D Slicer output. SPACE=LPS".ljust(80) + struct.pack("<I", len(triangles))
    for i, triangle in enumerate(triangles):
        content += struct.pack("<12fH", 0, 0, 0, *points[triangle].ravel(), i)
    return content


def plain_ply(points, faces, normals):
    """With nothing behind the corners of the faces."""
    content = ply_text(points, faces, normals)
    head, _, body = content.decode().partition("end_header\n")
    head = head.replace("property short part\n", "").replace("element edge 1\n", "")
    rows = body.splitlines()[:-1]
    polygons = [row.rsplit(" ", 1)[0] for row in rows[len(points) :]]
    head = head.replace("property int vertex1\n", "").replace("uchar red", "int red")
    return "\n".join([head + "end_header", *rows[: len(points)], *polygons, ""]).encode()


def plain_big_ply(points, faces, normals):
    content = plain_ply(points, faces, normals).replace(b"ascii", b"binary_big_endian")
    body = b"".join(
        struct.pack(">3dif3f", *p, i, 10 * i, *n) for i, (p, n) in enumerate(zip(points, normals))
    )
    body += b"".join(struct.pack(">B3i", 3, *face) for face in faces)
    return content[: content.index(b"end_header\n") + 11] + body
