"""What an operation makes of a file in that file's own format: all else the file holds stays."""

from __future__ import annotations

import io
import itertools
import struct
import subprocess
import sys

import numpy as np
import pytest
import trimesh
from attributed_files import (
    csv_text,
    obj,
    off,
    plain_big_ply,
    plain_ply,
    ply_binary,
    ply_text,
    stl,
    text,
)
from command_line import run_here
from symmetric_shapes import random_rotation

import symsurf
from symsurf.reading.gltf import Scene, tree_and_binary
from symsurf.saving.glb_format import glb_bytes
from symsurf.saving.same_format import REWRITERS, NewShape


@pytest.fixture
def box():
    """A box of quadrilaterals with a roof, mirrored in x, in any pose: corners and faces."""
    corners = [[x, y, z] for z in (0.0, 1.0) for y in (0.0, 2.0) for x in (-1.5, 1.5)]
    points = np.array([*corners, [0, 0.3, 1.7], [0.0, 1.2, 1.7]])
    faces = [[0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    faces += [[4, 5, 8], [7, 6, 9], [4, 8, 9, 6], [5, 7, 9, 8]]
    rng = np.random.default_rng(3)
    return points @ random_rotation(rng).T + [3, -2, 5], faces


FORMATS = {
    "text.ply": ply_text,
    "little.ply": lambda *a: ply_binary(*a, "<"),
    "big.ply": lambda *a: ply_binary(*a, ">"),
    "box.obj": obj,
    "box.off": off,
    "box.csv": csv_text,
}


@pytest.fixture(params=FORMATS)
def file(request, box, tmp_path):
    points, faces = box
    normals = points - points.mean(axis=0)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    path = tmp_path / request.param
    path.write_bytes(FORMATS[request.param](points, faces, normals.astype("f4").astype(float)))
    (tmp_path / "box.mtl").write_text("newmtl wood\n")
    assert len(symsurf.read(path).points) == len(points)
    return path


def done(line, file):
    result = run_here(f"{line} {file.name} --method plane --output made", file.parent)
    assert result.returncode == 0, result.stderr
    return file.parent / "made" / file.name, result.stderr


def test_align_turns_points_and_normals_and_keeps_the_rest(file):
    made, said = done("align --frame ras", file)
    before, after = symsurf.read(file), symsurf.read(made)
    expected = symsurf.align(file, symsurf.detect(file, "plane"), frame="ras")
    np.testing.assert_array_equal(after.points, expected.shape.points)
    np.testing.assert_array_equal(after.faces, before.faces)
    turned = before.normals @ expected.matrix[:3, :3].T
    np.testing.assert_allclose(after.normals, turned, atol=1e-7)
    assert said == ""
    content = made.read_bytes()
    if made.suffix != ".off":
        assert b"SPACE=RAS" in content and b"SPACE=LPS" not in content


def test_attributes_are_kept(file):
    made, _ = done("align", file)
    rows = [lines_of(path.read_bytes().replace(b"mtllib ../", b"mtllib ")) for path in (file, made)]
    assert len(rows[0]) == len(rows[1])
    for old, new in zip(*rows):
        assert new == old or without_what_turns(file, new) == without_what_turns(file, old)


ROW = 3 * 8 + 1 + 4 + 3 * 4  # a vertex in binary


def lines_of(content):
    """The lines of a text; of a binary PLY the header's, a row a vertex, and the rest."""
    if b"format binary" not in content:
        return content.split(b"\n")
    header, _, body = content.partition(b"end_header\n")
    rows = [body[i * ROW : (i + 1) * ROW] for i in range(10)]
    return [*header.split(b"\n"), *rows, body[10 * ROW :]]


def without_what_turns(file, row):
    """What stands in the row of a vertex, or of a normal, beside coordinates."""
    if file.suffix == ".ply" and file.name != "text.ply":
        return row[24:29] if len(row) == ROW else row
    words = row.split(b"," if file.suffix == ".csv" else None)
    kept = {
        ".ply": slice(3, 5),
        ".obj": slice(4, None),
        ".off": slice(6, None),
        ".csv": slice(0, 1),
    }
    is_point = len(words) >= 7 or words[:1] == [b"vn"]
    return words[kept[file.suffix]] if is_point else row


def test_normals_of_a_shape_that_changes_are_left_out_and_named(file):
    content = file.read_bytes()
    if file.suffix == ".obj":  # so that there is something to make even
        lines = content.split(b"\n")
        lines[3] = b"v " + b" ".join(repr(float(w) + 0.01).encode() for w in lines[3].split()[1:4])
        file.write_bytes(b"\n".join(lines))
    made, said = done("symmetrize --side positive", file)
    before, after = symsurf.read(file), symsurf.read(made)
    expected = symsurf.symmetrize(file, symsurf.detect(file, "plane"), side="positive")
    np.testing.assert_array_equal(after.points, expected.shape.points)
    np.testing.assert_array_equal(after.faces, before.faces)
    if not np.array_equal(after.points, before.points):
        assert after.normals is None and "the normals are left out" in said
    if file.suffix in (".obj", ".off"):
        assert "cannot hold the arrays paired" in said and "PLY and VTP can" in said
    elif file.suffix == ".ply":
        assert b"property uchar paired" in made.read_bytes()


def test_arrays_go_to_ply(file):
    result = run_here(f"asymmetry {file.name} --method plane --output made", file.parent)
    assert result.returncode == 0, result.stderr
    made = file.parent / "made" / f"{file.stem}.ply"
    after = symsurf.read(made)
    np.testing.assert_array_equal(after.points, symsurf.read(file).points)
    assert b"property double signed" in made.read_bytes()
    if file.suffix == ".ply":
        np.testing.assert_array_equal(after.normals, symsurf.read(file).normals)


@pytest.mark.parametrize("is_text", [True, False])
def test_stl(box, tmp_path, is_text):
    path = tmp_path / "box.stl"
    path.write_bytes(stl(*box, is_text))
    made, said = done("align --frame ras", path)
    expected = symsurf.align(path, symsurf.detect(path, "plane"), frame="ras").shape
    after = symsurf.read(made)
    corners = expected.points[expected.faces]
    if is_text:
        np.testing.assert_array_equal(after.points[after.faces], corners)
        assert said == "" and made.read_bytes().startswith(b"solid box SPACE=RAS\nfacet normal")
    else:
        np.testing.assert_array_equal(after.points[after.faces], corners.astype("f4"))
        assert "binary STL rounds coordinates to single precision" in said
        facets = np.frombuffer(made.read_bytes()[84:], "<3f4, <(3,3)f4, <u2")
        assert facets["f2"].tolist() == list(range(len(facets)))
        edges = np.diff(facets["f1"], axis=1)
        assert np.abs(np.einsum("ij,ikj->ik", facets["f0"], edges)).max() < 1e-5
        assert made.read_bytes()[:80] == b"3D Slicer output. SPACE=RAS".ljust(80)


def test_a_frame_is_named_where_the_file_names_none(box, tmp_path):
    """Slicer takes files that name none for LPS."""
    points, faces = box
    for name, content in {
        "a.obj": obj(points, faces, points),
        "a.ply": ply_text(points, faces, points),
    }.items():
        (tmp_path / name).write_bytes(content.replace(b"SPACE=LPS", b"nothing"))
        made, _ = done("align --frame ras", tmp_path / name)
        assert b"SPACE=RAS" in made.read_bytes()
        symsurf.read(made)


def test_vertices_that_are_not_plain_are_named(box, tmp_path):
    points, _ = box
    rows = "".join(text([*p, 1, 5]) + "\n" for p in points.tolist())
    header = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property double {axis}\n" for axis in "xyz")
    (tmp_path / "a.ply").write_text(header + "property list uchar int seen\nend_header\n" + rows)
    made, said = done("align", tmp_path / "a.ply")
    assert "nothing of the file is kept but points and faces" in said
    assert len(symsurf.read(made).points) == len(points)


def glb_parts(path):
    """Positions, normals, tangents, offsets of the morph target, and the description."""
    tree, binary = tree_and_binary(path.read_bytes())
    scene, (primitive,) = Scene(tree, binary), tree["meshes"][0]["primitives"]
    has = primitive["attributes"]
    stored = [(has["POSITION"], "VEC3"), (has["NORMAL"], "VEC3"), (has["TANGENT"], "VEC4")]
    stored.append((primitive["targets"][0]["POSITION"], "VEC3"))
    return [scene.stored(*each)[:, :3].astype(float) for each in stored], tree


@pytest.fixture
def morphed(tmp_path):
    """A GLB with a material, normals, tangents and a morph target, under a node that turns and shifts."""
    ball = trimesh.creation.icosphere(3)
    points = ball.vertices * (1, 1.3, 0.8)
    points[:, 2] += 0.2 * points[:, 1] ** 2
    normals = trimesh.Trimesh(points, ball.faces, process=False).vertex_normals
    tangents = np.column_stack([np.roll(normals, 1, 1), np.ones(len(normals))])
    buffers = [points, normals, tangents, 0.01 * normals]
    views = [each.astype("<f4").tobytes() for each in buffers]
    views.append(ball.faces.astype("<u4").tobytes())
    ends = np.cumsum([0, *map(len, views)]).tolist()
    accessors = [
        {"bufferView": k, "componentType": 5126, "count": len(each), "type": f"VEC{each.shape[1]}"}
        for k, each in enumerate(buffers)
    ]
    accessors.append(
        {"bufferView": 4, "componentType": 5125, "count": ball.faces.size, "type": "SCALAR"}
    )
    primitive = {
        "attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2},
        "targets": [{"POSITION": 3}],
        "indices": 4,
        "material": 0,
    }
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "rotation": [0, 0, 0.6, 0.8], "translation": [3, -2, 5]}],
        "meshes": [{"primitives": [primitive]}],
        "materials": [{"name": "skin"}],
        "accessors": accessors,
        "bufferViews": [
            {"buffer": 0, "byteOffset": first, "byteLength": last - first}
            for first, last in itertools.pairwise(ends)
        ],
        "buffers": [{"byteLength": ends[-1]}],
    }
    path = tmp_path / "morphed.glb"
    path.write_bytes(glb_bytes(tree, b"".join(views)))
    return path


def test_glb_keeps_materials_tangents_and_morph_targets(morphed, tmp_path):
    shape = symsurf.read(morphed)
    found = symsurf.detect(shape)
    aligned = symsurf.align(shape, found)
    aligned.save(tmp_path / "aligned.glb")
    (points, *given), _ = glb_parts(morphed)
    (_, *made), tree = glb_parts(tmp_path / "aligned.glb")
    c, s = 0.28, 0.96  # of twice the angle of the node
    node = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    turn = node.T @ aligned.matrix[:3, :3] @ node  # in the coordinates of the node
    for before, after in zip(given, made, strict=True):
        np.testing.assert_allclose(after, before @ turn.T, atol=2e-7)
    assert tree["materials"] == [{"name": "skin"}]
    again = symsurf.read(tmp_path / "aligned.glb")
    np.testing.assert_allclose(again.points, aligned.shape.points, atol=1e-6)
    assert np.abs(symsurf.detect(again).mirror.normal).max() > 1 - 1e-6

    symsurf.asymmetry(shape, found).save(tmp_path / "asymmetry.glb")
    kept, tree = glb_parts(tmp_path / "asymmetry.glb")
    assert (kept[0] == points).all() and tree["materials"] == [{"name": "skin"}]
    assert "_DISTANCE" in tree["meshes"][0]["primitives"][0]["attributes"]


@pytest.fixture
def broken_ball():
    """A bumpy mesh that mirrors in x, with a hole on one side: points, faces and normals."""
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.Icosphere(radius=1, nsub=4)
    points = np.array(mesh.points, dtype=float)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    normals = points.astype("f4").astype(float)
    _, y, z = points.T
    points *= (1 + 0.2 * np.sin(3 * y + 1) + 0.15 * np.cos(2 * z + 0.7) * y + 0.1 * z)[:, None]
    kept = np.linalg.norm(points - points[points[:, 0].argmax()], axis=1) > 0.35
    faces = mesh.regular_faces[kept[mesh.regular_faces].all(axis=1)]
    return points[kept], ((np.cumsum(kept) - 1)[faces]).tolist(), normals[kept]


COMPLETED = {
    "a.ply": plain_ply,
    "b.ply": plain_big_ply,
    "c.ply": ply_text,
    "a.obj": obj,
    "a.off": off,
}


@pytest.mark.parametrize("name", COMPLETED)
def test_what_is_added_takes_the_attributes_of_its_source(name, broken_ball, tmp_path):
    file = tmp_path / name
    file.write_bytes(COMPLETED[name](*broken_ball))
    made, said = done("complete", file)
    expected = symsurf.complete(file, symsurf.detect(file, "plane"))
    before, after = symsurf.read(file), symsurf.read(made)
    assert len(after.points) > len(before.points)
    np.testing.assert_array_equal(after.points, expected.shape.points)
    np.testing.assert_array_equal(after.faces, expected.shape.faces)
    if name == "c.ply":  # its faces have a part, of which what is added has none
        assert "nothing of the file is kept but points and faces" in said
        return
    texts = made.read_bytes().split(b"\n")
    count = len(after.points)
    if name == "a.ply":
        start = texts.index(b"end_header") + 1
        assert [
            int(row.split()[3]) for row in texts[start : start + count]
        ] == expected.sources.tolist()
    elif name == "a.obj":
        colours = [float(row.split()[6]) for row in texts if row.startswith(b"v ")]
        assert colours == (expected.sources / 16).tolist()
        assert texts[:2] == file.read_bytes().split(b"\n")[:2]
    elif name == "a.off":
        assert [int(row.split()[3]) for row in texts[2 : 2 + count]] == expected.sources.tolist()


@pytest.mark.parametrize("encoding", ["ascii", "binary_little_endian"])
@pytest.mark.parametrize(
    ("kind", "is_kept"), [("char", False), ("uchar", False), ("short", True), ("float", True)]
)
def test_an_index_type_too_small_for_what_is_added(kind, is_kept, encoding):
    points = np.random.default_rng(0).normal(size=(200, 3))
    header = f"ply\nformat {encoding} 1.0\ncomment by hand\nelement vertex 200\n"
    header += "".join(f"property double {axis}\n" for axis in "xyz")
    header += f"element face 1\nproperty list uchar {kind} vertex_indices\nend_header\n"
    if encoding == "ascii":
        body = "".join(text(row) + "\n" for row in [*points.tolist(), [3, 0, 1, 2]]).encode()
    else:
        code = {"char": "b", "uchar": "B", "short": "h", "float": "f"}[kind]
        body = points.tobytes() + struct.pack(f"<B3{code}", 3, 0, 1, 2)
    made, lost = rewritten(
        header.encode() + body,
        points=np.vstack([points, -points]),
        faces=np.array([[0, 1, 2], [399, 398, 397]]),
        old_faces=1,
        sources=np.tile(np.arange(200), 2),
        moved=False,
    )
    assert made.faces.tolist() == [[0, 1, 2], [399, 398, 397]]
    np.testing.assert_array_equal(made.points, np.vstack([points, -points]))
    assert lost == ([] if is_kept else ["nothing of the file is kept but points and faces"])


@pytest.mark.parametrize("encoding", ["ascii", "binary_little_endian"])
@pytest.mark.parametrize("name", ["heat", "x"])
def test_vertices_with_two_properties_of_one_name(name, encoding):
    rows = np.random.default_rng(0).normal(size=(9, 5))
    header = f"ply\nformat {encoding} 1.0\nelement vertex 9\n"
    header += "".join(f"property double {each}\n" for each in ("x", "y", "z", name, name))
    body = rows.tobytes()
    if encoding == "ascii":
        body = "".join(text(row) + "\n" for row in rows.tolist()).encode()
    made, lost = rewritten(
        (header + "end_header\n").encode() + body,
        points=2 * rows[:, :3],
        faces=np.empty((0, 3), int),
        old_faces=0,
        sources=np.arange(9),
        moved=True,
    )
    np.testing.assert_array_equal(made.points, 2 * rows[:, :3])
    assert lost == ["nothing of the file is kept but points and faces"]


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".off", ".csv"])
@pytest.mark.parametrize("turns", [False, True])
def test_a_byte_order_mark_is_passed_over(suffix, turns, box):
    points, faces = box
    normals = points.astype("f4").astype(float)
    content = {".ply": ply_text, ".obj": obj, ".off": off, ".csv": csv_text}[suffix](
        points, faces, normals
    )
    if suffix == ".obj":  # the first line is that of a vertex
        content = content[content.index(b"v ") :]
    turn = random_rotation(np.random.default_rng(5)) if turns else None
    fields = {
        "points": 2 * points,
        "faces": np.empty((0, 3), int),
        "old_faces": 0,
        "sources": np.arange(len(points)),
        "moved": True,
        "turn": turn,
    }
    plain, lost = rewritten(content, suffix, **fields)
    marked, also_lost = rewritten(b"\xef\xbb\xbf" + content, suffix, **fields)
    np.testing.assert_array_equal(marked.points, 2 * points)
    assert also_lost == lost and len(lost) == (not turns)
    assert (marked.normals is None) == (not turns)
    if turns:
        np.testing.assert_array_equal(marked.normals, plain.normals)


@pytest.mark.parametrize("end", ["end_header 1\n", " end_header\t by hand \r\n", "end_header\r\n"])
def test_what_stands_behind_the_end_of_a_header(end):
    points = np.arange(12.0).reshape(4, 3) % 5
    header = "ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
    header += "".join(f"property double {axis}\n" for axis in "xyz")
    made, lost = rewritten(
        (header + end).encode() + points.tobytes(),
        points=2 * points,
        faces=np.empty((0, 3), int),
        old_faces=0,
        sources=np.arange(4),
        moved=True,
    )
    np.testing.assert_array_equal(made.points, 2 * points)
    assert lost == []


@pytest.mark.parametrize("left", [3, 0, None])
def test_a_text_that_was_shortened_after_it_was_read(left, box):
    """In a process of its own, which a loop without end would keep."""
    header, mark, body = ply_text(*box, box[0]).partition(b"end_header\n")
    content = header
    if left is not None:
        content += mark + b"\n".join(body.split(b"\n")[:left])
    points = box[0].tolist()
    script = f"""
import numpy as np
from symsurf.saving.same_format import REWRITERS, NewShape
points = np.array({points})
new = NewShape(points, np.empty((0, 3), int), 0, np.arange(len(points)), False)
REWRITERS[".ply"]({content!r}, new)
"""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.stderr.splitlines()[-1].endswith(
        "InvalidInput: the file was changed after it was read"
    )


def rewritten(content, suffix=".ply", **fields):
    """What is read of the new content, and what it lost."""
    new = REWRITERS[suffix](content, NewShape(**fields))
    return symsurf.read(io.BytesIO(new.content), suffix[1:]), new.lost


def test_a_cloud_is_completed_in_its_columns(broken_ball, tmp_path):
    points, _, normals = broken_ball
    (tmp_path / "a.csv").write_bytes(csv_text(points, [], normals))
    made, _ = done("complete", tmp_path / "a.csv")
    expected = symsurf.complete(points, symsurf.detect(points, "plane", normals=normals))
    rows = made.read_text().splitlines()[1:]
    assert rows[0] == "id,x,y,z,nx,ny,nz,origin" or rows[0] == "id,x,y,z,origin"
    assert [int(row.split(",")[0]) for row in rows[1:]] == expected.sources.tolist()
    np.testing.assert_array_equal(symsurf.read(made).points, expected.shape.points)


@pytest.mark.parametrize("suffix", ["csv", "ply"])
def test_points_that_are_not_finite_keep_what_they_have(suffix, tmp_path):
    rows = ["nan nan nan 7", "1 2 0.5 1", "2 1 3 2", "-1 0 0.1 3", "-1 2 0.5 4", "-2 1 3 5"]
    heads = {
        "csv": "x,y,z,label\n",
        "ply": "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
        "property double z\nproperty int label\nend_header\n",
    }
    file = tmp_path / f"points.{suffix}"
    body = "\n".join(rows) + "\n"
    file.write_text(heads[suffix] + (body.replace(" ", ",") if suffix == "csv" else body))
    mirror = tmp_path / "mirror.json"
    mirror.write_text('{"mirror": {"kind": "plane", "normal": [1, 0, 0], "offset": 0}}')
    for operation in ("align", "transfer"):
        done = run_here(f"{operation} {file} --mirror {mirror} --output {operation}", tmp_path)
        assert done.returncode == 0 and "nothing of the file is kept" not in done.stderr
        (made,) = (tmp_path / operation).glob(f"*.{suffix}")
        labels = [line.replace(",", " ").split()[3] for line in made.read_text().splitlines()[-6:]]
        assert labels[0] == "7" and (operation == "transfer" or labels == list("712345"))
