"""Polygons, materials and textures of files: kept where the format can hold them, else reported."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from command_line import run_here

import symsurf
from symsurf.shapes.polygons import carried_polygons, corners_of

SIDE = 9
PLANE = '{"mirror": {"kind": "plane", "normal": [1, 0, 0], "offset": 0}}'


def sheet() -> tuple[np.ndarray, list[list[int]]]:
    """A sheet of quadrilaterals, one of which is two triangles, and a hexagon of four of them: mirrored
    in x."""
    steps = np.linspace(-1, 1, SIDE)
    x, y = np.meshgrid(steps, steps, indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), (1 - x * x - y * y / 2).ravel()])
    corner = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    faces = []
    for i in range(SIDE - 1):
        for j in range(SIDE - 1):
            a, b, c, d = corner[i, j], corner[i + 1, j], corner[i + 1, j + 1], corner[i, j + 1]
            if (i, j) == (0, 0):
                faces += [[a, b, c], [a, c, d]]
            elif (i, j) == (SIDE - 2, 0):
                faces += [[a, b, d], [b, c, d]]
            elif j == 4 and i in (2, 5):
                faces.append([a, b, corner[i + 1, j + 2], corner[i, j + 2]])
                faces[-1][2:2] = [c]
                faces[-1].append(d)
            elif not (j == 5 and i in (2, 5)):
                faces.append([a, b, c, d])
    return points, [[int(c) for c in face] for face in faces]


def obj(points, faces) -> bytes:
    """With three materials in turn, and texture coordinates."""
    lines = ["mtllib sheet.mtl", *(f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist())]
    lines += [f"vt {x!r} {y!r}" for x, y, _ in points.tolist()]
    for number, face in enumerate(faces):
        lines.append(f"usemtl m{number % 3}")
        lines.append("f " + " ".join(f"{corner + 1}/{corner + 1}" for corner in face))
    return ("\n".join(lines) + "\n").encode()


def off(points, faces) -> bytes:
    rows = [" ".join(map(repr, point)) for point in points.tolist()]
    rows += [
        " ".join(map(str, [len(face), *face, number % 256, 0, 255]))
        for number, face in enumerate(faces)
    ]
    return ("\n".join(["OFF", f"{len(points)} {len(faces)} 0", *rows]) + "\n").encode()


def ply(points, faces, encoding: str) -> bytes:
    header = (
        f"ply\nformat {encoding} 1.0\nelement vertex {len(points)}\nproperty double x\n"
        f"property double y\nproperty double z\nelement face {len(faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).encode()
    if encoding == "ascii":
        rows = [" ".join(map(repr, point)) for point in points.tolist()]
        rows += [" ".join(map(str, [len(face), *face])) for face in faces]
        return header + ("\n".join(rows) + "\n").encode()
    rows = [np.array(len(f), "u1").tobytes() + np.array(f, "<i4").tobytes() for f in faces]
    return header + points.astype("<f8").tobytes() + b"".join(rows)


CONTENTS = {
    "sheet.obj": obj,
    "sheet.off": off,
    "sheet.ply": lambda *shape: ply(*shape, "ascii"),
    "binary.ply": lambda *shape: ply(*shape, "binary_little_endian"),
}


@pytest.fixture(params=CONTENTS)
def file(request, tmp_path) -> Path:
    path = tmp_path / request.param
    path.write_bytes(CONTENTS[request.param](*sheet()))
    (tmp_path / "mirror.json").write_text(PLANE)
    (tmp_path / "sheet.mtl").write_text("newmtl m0\n")
    return path


def polygons_in(path: Path) -> list[list[tuple[float, ...]]]:
    """The corners of each, from the least on."""
    shape = symsurf.read(path)
    found = []
    for _, corners in corners_of(shape.faces, shape.polygons):
        rows = [tuple(row) for row in shape.points[corners].round(9).tolist()]
        least = rows.index(min(rows))
        found.append(rows[least:] + rows[:least])
    return sorted(found)


def images(polygons):
    found = []
    for polygon in polygons:
        rows = [(-x + 0.0, y, z) for x, y, z in reversed(polygon)]
        least = rows.index(min(rows))
        found.append(rows[least:] + rows[:least])
    return sorted(found)


def made(operation: str, file: Path, words: str = "") -> tuple[Path, str]:
    line = f"{operation} {file.name} --mirror mirror.json --output out {words}"
    done = run_here(line, file.parent)
    assert done.returncode == 0, done.stderr
    return file.parent / "out" / file.name, done.stderr


def test_polygons_are_read(file):
    _, faces = sheet()
    shape = symsurf.read(file)
    assert [corners for _, corners in corners_of(shape.faces, shape.polygons)] == faces
    assert sorted({len(face) for face in faces}) == [3, 4, 6]
    assert symsurf.read(file).polygons.shape == (len(shape.faces),)


def test_no_polygons_where_all_are_triangles(tmp_path):
    points, faces = sheet()
    triangles = [[face[0], *pair] for face in faces for pair in pairwise(face[1:])]
    for name, content in CONTENTS.items():
        (tmp_path / name).write_bytes(content(points, triangles))
        shape = symsurf.read(tmp_path / name)
        assert shape.polygons is None and shape.faces.tolist() == triangles


@pytest.mark.parametrize("operation", ["align", "symmetrize", "symmetrize --triangles mirrored"])
def test_they_are_written(operation, file):
    given = polygons_in(file)
    result, said = made(operation, file)
    assert "triangles are written" not in said and "nothing of the file" not in said
    sizes = sorted(map(len, polygons_in(result)))
    assert sizes == sorted(map(len, given))
    if operation != "align":
        assert polygons_in(result) == given


def test_images_of_polygons_are_polygons(file):
    """Half of the sheet, completed."""
    points, faces = sheet()
    half = [face for face in faces if all(points[corner][0] <= 0 for corner in face)]
    kept = points[:, 0] <= 0
    number = np.cumsum(kept) - 1
    half = [[int(number[corner]) for corner in face] for face in half]
    file.write_bytes(CONTENTS[file.name](points[kept], half))
    given = polygons_in(file)
    result, _ = made("complete", file, "--max_angle 90")
    found = polygons_in(result)
    away = [polygon for polygon in given if max(x for x, _, _ in polygon) < -0.1]
    assert len(away) > 20 and {len(polygon) for polygon in away} == {3, 4, 6}
    assert all(polygon in found for polygon in [*given, *images(away)])  # between is the seam


def test_what_is_cut_or_remeshed_is_reported(file):
    _, said = made("remesh", file)
    assert "triangles are written of what were larger polygons" in said
    shape = symsurf.remesh(symsurf.read(file), symsurf.Plane((1, 0, 0), 0)).shape
    assert shape.polygons is None


def test_other_formats_have_the_polygons(file):
    result = symsurf.symmetrize(symsurf.read(file), symsurf.Plane((1, 0, 0), 0))
    for suffix in (".ply", ".obj", ".off"):
        result.save(file.parent / f"saved{suffix}")
        assert polygons_in(file.parent / f"saved{suffix}") == polygons_in(file)
    pyvista = pytest.importorskip("pyvista")
    result.save(file.parent / "saved.vtp")
    mesh = pyvista.read(file.parent / "saved.vtp")
    sizes = [cell.n_points for cell in mesh.cell]
    assert sizes == [len(face) for face in sheet()[1]]


def test_polygons_of_very_many_corners(tmp_path):
    turns = np.linspace(0, 2 * np.pi, 600, endpoint=False)
    points = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(600)])
    (tmp_path / "disc.off").write_bytes(off(points, [list(range(600))]))
    shape = symsurf.read(tmp_path / "disc.off")
    aligned = symsurf.align(shape, symsurf.Plane((1, 0, 0), 0))
    aligned.save(tmp_path / "disc.ply")
    again = symsurf.read(tmp_path / "disc.ply")
    assert corners_of(again.faces, again.polygons) == [(0, list(range(600)))]


def test_pieces_are_no_polygon():
    """Triangles that are not all of a polygon, not in its order, or that hold other points."""
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    given = symsurf.Shape(np.zeros((4, 3)), faces, polygons=np.zeros(2, int))
    points, own = np.arange(4), np.arange(2)
    assert carried_polygons(faces[:, [1, 2, 0]], own, points, given).tolist() == [0, 0]
    assert carried_polygons(faces[::-1], own[::-1], points, given) is None
    assert carried_polygons(faces[:1], own[:1], points, given) is None
    assert carried_polygons(faces[:, ::-1], own, np.array([0, 1, 2, -1]), given) is None


# Materials and textures.


def faces_of(path: Path) -> list[tuple[str, list[str]]]:
    """Of each face its material and its corners."""
    material, found = "", []
    for line in path.read_text().splitlines():
        if line.startswith("usemtl "):
            material = line.split()[1]
        elif line.startswith("f "):
            found.append((material, line.split()[1:]))
    return found


@pytest.mark.parametrize("operation", ["symmetrize --triangles mirrored", "cut", "remesh"])
def test_each_material_is_named_once(operation, tmp_path):
    file = tmp_path / "sheet.obj"
    file.write_bytes(obj(*sheet()))
    (tmp_path / "sheet.mtl").write_text("newmtl m0\n")
    (tmp_path / "mirror.json").write_text(PLANE)
    result, said = made(operation, file)
    text = result.read_text()
    assert text.count("usemtl") == 3 and "mtllib" not in said
    assert {material for material, _ in faces_of(result)} == {"m0", "m1", "m2"}
    assert all("/" in corner for _, face in faces_of(result) for corner in face)


def test_added_faces_have_the_material_and_the_texture_of_their_sources(tmp_path):
    points, faces = sheet()
    kept = points[:, 0] <= 0
    number = np.cumsum(kept) - 1
    half = [[int(number[c]) for c in face] for face in faces if kept[face].all()]
    file = tmp_path / "sheet.obj"
    file.write_bytes(obj(points[kept], half))
    (tmp_path / "mirror.json").write_text(PLANE)
    result, said = made("complete", file, "--max_angle 90")
    assert "the library of materials sheet.mtl is not beside the file" in said
    lines = result.read_text().splitlines()
    texture = [line.split()[1:] for line in lines if line.startswith("vt ")]
    vertices = [line.split()[1:4] for line in lines if line.startswith("v ")]
    found = faces_of(result)
    own, added = found[: len(half)], found[len(half) :]
    materials = {tuple(sorted(corner.split("/")[1] for corner in face)): name for name, face in own}
    images = 0
    for name, face in added:
        at = [[float(w) for w in texture[int(corner.split("/")[1]) - 1]] for corner in face]
        where = [[float(w) for w in vertices[int(corner.split("/")[0]) - 1]] for corner in face]
        if min(x for x, _, _ in where) < 0.1:  # the seam
            continue
        images += 1
        np.testing.assert_allclose(np.array(at) * [-1, 1], np.array(where)[:, :2], atol=1e-9)
        sources = [
            next(i for i, t in enumerate(texture) if [float(w) for w in t] == each) for each in at
        ]
        assert materials[tuple(sorted(str(i + 1) for i in sources))] == name
    assert images > 20


def test_a_library_of_materials_is_found_from_the_output(tmp_path):
    file = tmp_path / "in" / "sheet.obj"
    (tmp_path / "in" / "below").mkdir(parents=True)
    content = obj(*sheet()).replace(
        b"mtllib sheet.mtl", b"mtllib below/a.mtl b.mtl\nmtllib two words.mtl\nmtllib none.mtl"
    )
    file.write_bytes(content)
    for name in ("below/a.mtl", "b.mtl", "two words.mtl"):
        (file.parent / name).write_text("newmtl m0\n")
    (tmp_path / "mirror.json").write_text(PLANE)
    for operation in ("align", "cut"):
        line = f"{operation} in/sheet.obj --mirror mirror.json --output out/{operation}"
        done = run_here(line, tmp_path)
        assert done.returncode == 0
        result = tmp_path / "out" / operation / "sheet.obj"
        named = [
            line.removeprefix("mtllib ")
            for line in result.read_text().splitlines()
            if line.startswith("mtllib ")
        ]
        found = [(result.parent / name).exists() for name in named]
        assert found == [True, True, True, False] and named[3] == "none.mtl"
        assert done.stderr.count("is not beside the file") == 1 and "none.mtl" in done.stderr


def test_what_another_format_does_not_hold_is_reported(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    points, faces = sheet()
    triangles = [[face[0], *pair] for face in faces for pair in pairwise(face[1:])]
    visual = trimesh.visual.TextureVisuals(uv=points[:, :2])
    trimesh.Trimesh(points, triangles, visual=visual, process=False).export(tmp_path / "sheet.glb")
    (tmp_path / "mirror.json").write_text(PLANE)
    done = run_here("align sheet.glb --mirror mirror.json --output out --format ply", tmp_path)
    assert done.returncode == 0 and "textures" in done.stderr and "GLB" in done.stderr
    assert (tmp_path / "out" / "sheet.ply").exists()
    np.savetxt(tmp_path / "plain.xyz", points)
    done = run_here("asymmetry plain.xyz --mirror mirror.json --output out --json", tmp_path)
    assert done.stderr == "" and json.loads(done.stdout)["notices"] == []
