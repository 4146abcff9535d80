"""What the points have, carried over a mirror: exact between exact partners, and into every host."""

import numpy as np
import pytest
import pyvista
from command_line import run_here

import symsurf

PLANE = symsurf.Plane((1, 0, 0), 0)


@pytest.fixture(scope="module")
def ball():
    """Whose vertices the plane maps onto each other."""
    mesh = pyvista.Icosphere(radius=1, nsub=3)
    x, y, z = np.array(mesh.points, dtype=float).T
    points = np.column_stack([x, 0.8 * y + 0.3 * z**2, 1.2 * z + 0.25 * y**2])
    return symsurf.Shape(points, mesh.regular_faces)


def partner_of(points):
    """By brute force."""
    away = np.linalg.norm(points[:, None] * (-1, 1, 1) - points, axis=2)
    assert away.min(axis=1).max() < 1e-6
    return away.argmin(axis=1)


def test_labels_and_values_of_one_side_come_to_the_other(ball):
    points = ball.points
    labels = np.random.default_rng(5).integers(0, 1000, len(points))
    values = np.random.default_rng(6).normal(size=(len(points), 2))
    partner = partner_of(points)
    made = symsurf.transfer({"labels": labels, "values": values}, ball, PLANE)
    is_given = points[:, 0] < -1e-6
    np.testing.assert_array_equal(
        made.values["labels"], np.where(is_given, labels[partner], labels)
    )
    np.testing.assert_array_equal(
        made.values["values"], np.where(is_given[:, None], values[partner], values)
    )
    assert not made.failed.any() and made.statistics["failed_points"] == 0
    np.testing.assert_array_equal(made.shape.points, points)
    np.testing.assert_array_equal(made.shape.faces, ball.faces)
    other = symsurf.transfer(labels, ball, PLANE, side="negative").values
    np.testing.assert_array_equal(other, np.where(points[:, 0] > 1e-6, labels[partner], labels))


def test_averages_are_symmetric(ball):
    values = np.random.default_rng(7).normal(size=len(ball.points))
    partner = partner_of(ball.points)
    made = symsurf.transfer(values, ball, PLANE, side="average")
    np.testing.assert_allclose(made.values, (values + values[partner]) / 2, rtol=1e-14)
    colours = np.random.default_rng(8).integers(0, 256, (len(values), 3)).astype(np.uint8)
    mixed = made.carried(colours)
    assert mixed.dtype == np.uint8
    mean = (colours.astype(float) + colours[partner]) / 2
    assert np.abs(mixed - mean).max() <= 0.5


def test_displacements_are_mirrored(ball):
    points, partner = ball.points, partner_of(ball.points)
    moves = 0.1 * np.random.default_rng(9).normal(size=points.shape)
    made = symsurf.transfer(None, ball, PLANE)
    mirrored = moves[partner] * (-1, 1, 1)
    is_given = points[:, :1] < -1e-6
    np.testing.assert_allclose(
        made.displaced(moves), np.where(is_given, mirrored, moves), atol=1e-12
    )
    even = symsurf.transfer(None, ball, PLANE, side="average").displaced(moves)
    np.testing.assert_allclose(even, (moves + mirrored) / 2, atol=1e-12)


def test_between_vertices_values_are_interpolated():
    """Of a resampled ball whose vertices are nobody's partners."""
    rng = np.random.default_rng(10)
    points = rng.normal(size=(2000, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    faces = pyvista.PolyData(points).delaunay_3d().extract_surface(algorithm=None)
    shape = symsurf.Shape(np.array(faces.points, float), faces.triangulate().regular_faces)
    values = shape.points @ (0.3, 1, -2) + 5
    made = symsurf.transfer(values, shape, PLANE)
    there = shape.points.copy()
    there[:, 0] = np.abs(there[:, 0])
    error = np.abs(made.values - (there @ (0.3, 1, -2) + 5))
    assert error.max() < 0.02  # the sagitta of the facets, times the gradient


def test_what_has_no_counterpart_keeps_its_own(ball):
    points = ball.points
    kept = ~((points[ball.faces].mean(axis=1) @ (1, 0, 0)) > 0.6)
    used = np.unique(ball.faces[kept])
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    broken = symsurf.Shape(points[used], number[ball.faces[kept]])
    values = np.arange(len(used), dtype=float)
    made = symsurf.transfer(values, broken, PLANE)
    assert 0 < made.failed.sum() == made.statistics["failed_points"] < len(used) / 2
    assert (broken.points[made.failed, 0] < -0.5).all()
    np.testing.assert_array_equal(made.values[made.failed], values[made.failed])


def test_values_of_the_wrong_length_are_an_error(ball):
    with pytest.raises(
        symsurf.InvalidInput, match=r"values has shape \(3,\); allowed is one value"
    ):
        symsurf.transfer([1, 2, 3], ball, PLANE)
    with pytest.raises(symsurf.InvalidInput, match=r"weights has shape \(\)"):
        symsurf.transfer({"weights": 1.0}, ball, PLANE)


def test_pyvista_meshes_keep_normals_and_texture_coordinates(ball):
    mesh = ball.to_pyvista().compute_normals()
    mesh.point_data["uv"] = ball.points[:, :2]
    mesh.active_texture_coordinates = ball.points[:, :2]
    mesh.point_data["weight"] = ball.points[:, 0]
    mesh.symmetry.result = symsurf.match(mesh, PLANE)
    made = mesh.symmetry.transfer(side="negative")
    np.testing.assert_allclose(made.point_data["weight"], -np.abs(ball.points[:, 0]), atol=1e-6)
    np.testing.assert_array_equal(made.active_texture_coordinates, mesh.active_texture_coordinates)
    np.testing.assert_array_equal(made.point_data["Normals"], mesh.point_data["Normals"])
    assert made.n_cells == mesh.n_cells


@pytest.mark.parametrize("name", ["ball.ply", "ball.obj", "ball.csv"])
def test_files_keep_their_format(ball, tmp_path, name):
    points, partner = ball.points, partner_of(ball.points)
    red = np.random.default_rng(11).random(len(points)).round(3)
    rows = [" ".join(map(repr, row)) for row in np.column_stack([points, red]).tolist()]
    faces = ["3 " + " ".join(map(str, face)) for face in ball.faces.tolist()]
    if name.endswith("ply"):
        names = [f"property double {name}" for name in ("x", "y", "z", "weight")]
        header = ["ply", "format ascii 1.0", f"element vertex {len(points)}", *names]
        header += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
        lines = [*header, "end_header", *rows, *faces]
    elif name.endswith("obj"):
        lines = [f"v {row} {r!r} {r!r}" for row, r in zip(rows, red.tolist())]
        lines += ["f " + " ".join(str(c + 1) for c in face) for face in ball.faces.tolist()]
    else:
        lines = ["x,y,z,weight", *(row.replace(" ", ",") for row in rows)]
    (tmp_path / name).write_text("\n".join(lines) + "\n")
    done = run_here(f"transfer {name} --method plane --output out --side positive", tmp_path)
    assert done.returncode == 0, done.stderr
    made = read_weights(tmp_path / "out" / name, len(points))
    # The plane that is found may face either way.
    sides = [np.where(sign * points[:, 0] < -1e-6, red[partner], red) for sign in (1, -1)]
    assert any(np.allclose(made, side, atol=1e-12) for side in sides)


def read_weights(path, count):
    lines = path.read_text().splitlines()
    if path.suffix == ".csv":
        return np.array([line.split(",")[3] for line in lines[1 : count + 1]], float)
    if path.suffix == ".obj":
        return np.array([line.split()[4] for line in lines if line.startswith("v ")], float)
    start = lines.index("end_header") + 1
    return np.array([line.split()[3] for line in lines[start : start + count]], float)


def test_other_files_are_refused(ball, tmp_path):
    ball.to_pyvista().save(tmp_path / "ball.vtp")
    done = run_here("transfer ball.vtp --output out", tmp_path)
    assert done.returncode != 0
    assert "cannot be carried over" in done.stderr
    assert not list((tmp_path / "out").glob("*"))


def test_pairs_are_saved_as_makehuman_reads_them(ball, tmp_path):
    symsurf.correspondences(ball, PLANE).save(tmp_path / "ball.mirror")
    rows = [line.split() for line in (tmp_path / "ball.mirror").read_text().splitlines()]
    assert [int(row[0]) for row in rows] == list(range(len(ball.points)))
    np.testing.assert_array_equal([int(row[1]) for row in rows], partner_of(ball.points))
    for (_, _, side), x in zip(rows, ball.points[:, 0], strict=True):
        assert side == ("m" if abs(x) < 1e-6 else "l" if x > 0 else "r")
    with pytest.raises(symsurf.InvalidParameter, match="allowed are the suffixes"):
        symsurf.align(ball, PLANE).save(tmp_path / "other.mirror")
