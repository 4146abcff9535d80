"""One side's triangles mirrored: exact partners, and attributes that go along into every host."""

import numpy as np
import pytest
import pyvista
from command_line import run_here

import symsurf

PLANE = symsurf.Plane((1, 0.2, 0.1), 0.03)


@pytest.fixture(scope="module")
def mesh():
    """An ellipsoid whose texture coordinates are linear in its points."""
    mesh = pyvista.Icosphere(radius=1, nsub=3)
    points = np.array(mesh.points, dtype=float) * (1, 0.8, 1.2)
    mesh = pyvista.PolyData(points, mesh.faces)
    mesh.point_data["texture"] = texture_at(points)
    mesh.active_texture_coordinates = texture_at(points)
    mesh.point_data["part"] = (points[:, 2] > 0).astype(np.int32)
    mesh.cell_data["patch"] = np.arange(mesh.n_cells)
    return mesh


def texture_at(points):
    return points[:, 1:] * (0.3, 0.2) + 0.5


def on_the_positive_side(points, mirror=PLANE):
    negative = mirror.signed_distance(points) < 0
    return np.where(negative[:, None], mirror.reflect(points), points)


def test_partners_are_exact_and_attributes_go_along(mesh):
    shape = symsurf.Shape(mesh.points, mesh.regular_faces)
    made = symsurf.symmetrize(shape, PLANE, side="positive", triangles="mirrored")
    points = made.shape.points
    np.testing.assert_array_equal(made.partner[made.partner], np.arange(len(points)))
    np.testing.assert_allclose(PLANE.reflect(points), points[made.partner], atol=1e-14)
    images = made.partner[made.shape.faces[:, [0, 2, 1]]]
    faces = {tuple(np.roll(face, -np.argmin(face))) for face in made.shape.faces}
    assert {tuple(np.roll(face, -np.argmin(face))) for face in images} == faces
    own = on_the_positive_side(points)
    np.testing.assert_allclose(made.carried(texture_at(shape.points)), texture_at(own), atol=1e-14)
    labels = np.arange(len(shape.points))
    np.testing.assert_array_equal(made.carried(labels), made.sources)
    assert len(made.face_sources) == len(made.shape.faces)
    kept = symsurf.symmetrize(shape, PLANE)
    assert kept.parents is None and kept.partner is None
    np.testing.assert_array_equal(kept.carried(labels), labels)


def test_pyvista_meshes_keep_their_arrays(mesh):
    mirror = mesh.symmetry.detect("plane").mirror
    made = mesh.symmetry.symmetrize(side="positive", triangles="mirrored")
    own = texture_at(on_the_positive_side(np.asarray(made.points, dtype=float), mirror))
    np.testing.assert_allclose(made.point_data["texture"], own, atol=1e-6)
    np.testing.assert_allclose(made.active_texture_coordinates, own, atol=1e-6)
    assert made.point_data["part"].dtype == np.int32
    assert set(made.cell_data["patch"]) <= set(range(mesh.n_cells))
    assert made.is_manifold


@pytest.mark.parametrize("binary", [True, False])
def test_ply_files_keep_the_properties_of_their_vertices(mesh, tmp_path, binary):
    source = tmp_path / "egg.ply"
    part = np.asarray(mesh.point_data["part"])
    header = ["ply", f"format {'binary_little_endian' if binary else 'ascii'} 1.0"]
    header += [f"element vertex {mesh.n_points}"]
    header += [f"property double {axis}" for axis in "xyz"] + ["property uchar red"]
    header += [
        f"element face {mesh.n_cells}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    faces = mesh.regular_faces
    if binary:
        rows = np.empty(mesh.n_points, [("p", "<f8", 3), ("red", "u1")])
        rows["p"], rows["red"] = mesh.points, part
        ends = np.empty(len(faces), [("n", "u1"), ("c", "<i4", 3)])
        ends["n"], ends["c"] = 3, faces
        body = rows.tobytes() + ends.tobytes()
    else:
        lines = [f"{x!r} {y!r} {z!r} {red}" for (x, y, z), red in zip(mesh.points.tolist(), part)]
        lines += ["3 " + " ".join(map(str, face)) for face in faces]
        body = ("\n".join(lines) + "\n").encode()
    source.write_bytes("\n".join(header).encode() + b"\n" + body)
    done = run_here(
        "symmetrize egg.ply --output out --triangles mirrored --side positive", tmp_path
    )
    assert done.returncode == 0, done.stderr
    made = symsurf.read(tmp_path / "out/egg.ply")
    read = pyvista.read(tmp_path / "out/egg.ply")
    np.testing.assert_allclose(made.points, read.points, atol=1e-6)  # read in single precision
    assert len(made.faces) % 2 == 0
    assert symsurf.asymmetry(made, symsurf.detect(made, "plane")).statistics["rms"] < 1e-9
    assert b"property uchar red" in (tmp_path / "out/egg.ply").read_bytes()
    assert "nothing of the file is kept" not in done.stderr


def test_obj_files_keep_textures_materials_and_groups(mesh, tmp_path):
    """Faces of two materials that meet in a seam, along which texture coordinates jump."""
    points, faces = np.array(mesh.points, dtype=float), mesh.regular_faces
    is_upper = points[faces].mean(axis=1)[:, 2] > 0
    texture = np.vstack([texture_at(points), texture_at(points) + 10])
    lines = ["# an egg", "mtllib egg.mtl", *(f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist())]
    lines += [f"vt {u!r} {v!r}" for u, v in texture.tolist()]
    for upper, material in ((False, "white"), (True, "yolk")):
        lines += [f"usemtl {material}", f"g {material}"]
        shift = len(points) * upper
        for face in faces[is_upper == upper] + 1:
            lines.append("f " + " ".join(f"{corner}/{corner + shift}" for corner in face))
    (tmp_path / "egg.obj").write_text("\n".join(lines) + "\n")
    done = run_here("symmetrize egg.obj --output out --triangles mirrored --method plane", tmp_path)
    assert done.returncode == 0 and "nothing of the file" not in done.stderr, done.stderr
    text = (tmp_path / "out/egg.obj").read_text()
    assert text.startswith("# an egg\nmtllib egg.mtl\nv ")
    made = symsurf.read(tmp_path / "out/egg.obj")
    given = [line.split() for line in text.splitlines()]
    coordinates = np.array([words[1:] for words in given if words[:1] == ["vt"]], float)
    corners, of_material, material = [], [], ""
    for words in given:
        material = words[1] if words[:1] == ["usemtl"] else material
        if words[:1] == ["f"]:
            corners.append([int(word.split("/")[1]) - 1 for word in words[1:]])
            of_material.append(material)
    assert len(corners) == len(made.faces)
    mirror = symsurf.detect(tmp_path / "egg.obj", "plane").mirror
    partner = symsurf.symmetrize(symsurf.read(tmp_path / "egg.obj"), mirror, triangles="mirrored")
    own = made.points.copy()
    is_image = np.arange(len(own)) > partner.partner  # the images come last
    own[is_image] = mirror.reflect(own[is_image])
    shift = 10 * (np.array(of_material) == "yolk")[:, None, None]
    # The average of both sides has moved, what its points lie between has not.
    np.testing.assert_allclose(coordinates[corners], texture_at(own)[made.faces] + shift, atol=1e-3)


def test_other_files_say_what_they_lose(mesh, tmp_path):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.points.tolist()]
    lines += ["f " + " ".join(str(c + 1) for c in face) for face in mesh.regular_faces]
    lines[0] += " \\\n"  # a statement over two lines
    (tmp_path / "egg.obj").write_text("\n".join(["o egg", *lines]) + "\n")
    done = run_here("symmetrize egg.obj --output out --triangles mirrored", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "nothing of the file is kept but points and faces" in done.stderr
    made = symsurf.read(tmp_path / "out/egg.obj")
    assert len(made.faces) % 2 == 0 and len(made.points) > 0


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"strength": 0.5}, "allowed with these is kept"),
        ({"triangles": "both"}, r"triangles is both; allowed is choice kept \| mirrored"),
    ],
)
def test_what_does_not_go_together_is_an_error(mesh, options, says):
    shape = symsurf.Shape(mesh.points, mesh.regular_faces)
    with pytest.raises(symsurf.InvalidParameter, match=says):
        symsurf.symmetrize(shape, PLANE, **{"triangles": "mirrored", **options})
