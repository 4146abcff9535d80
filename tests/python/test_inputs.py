"""What detect takes beside arrays: files and meshes; and points that are not finite."""

from __future__ import annotations

import subprocess
import sys
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from command_line import run
from seeds import each_seed
from symmetric_shapes import is_near, mirrored_surface, random_rotation

import symsurf

SIDES = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]


def box(low, high, flips=0):
    """Eight corners and twelve triangles; flips says which diagonal divides each side."""
    corners = np.array(
        [[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)], float
    )
    faces = []
    for number, side in enumerate(SIDES):
        c = np.roll(side, -(flips >> number & 1))
        faces += [(c[0], c[1], c[2]), (c[0], c[2], c[3])]
    return corners, np.array(faces)


def chair(seed):
    """Seat, back and legs, turned; the mirror is x = 0.5 before that."""
    boxes = [box((0, 0, 0.45), (1, 1, 0.5), seed), box((0, 0.95, 0.5), (1, 1, 1.2), 11)]
    for n, (x, y) in enumerate([(0, 0), (0.93, 0), (0, 0.93), (0.93, 0.93)]):
        boxes.append(box((x, y, 0), (x + 0.07, y + 0.07, 0.45), 7 * n + seed))
    points = np.vstack([corners for corners, _ in boxes])
    faces = np.vstack([faces + 8 * n for n, (_, faces) in enumerate(boxes)])
    rotation = random_rotation(np.random.default_rng(seed))
    normal = rotation[:, 0]
    return points @ rotation.T, faces, normal, 0.5 * normal


def off(path, points, faces=()):
    rows = [" ".join(map(repr, point)) for point in points.tolist()]
    rows += ["3 " + " ".join(map(str, face)) for face in np.asarray(faces).tolist()]
    path.write_text(f"OFF\n{len(points)} {len(faces)} 0\n" + "\n".join(rows) + "\n")
    return path


# Points that are not finite


def with_nan(points, every=7):
    keep = np.flatnonzero(np.arange(2 * len(points)) % every != 3)[: len(points)]
    given = np.full((keep[-1] + 1, 3), np.nan)
    given[keep] = points
    return given, keep


@pytest.mark.parametrize("method", ["plane", "auto", "normals_only"])
def test_points_that_are_not_finite_are_left_out(method):
    points, _ = mirrored_surface(400, 3)
    given, keep = with_nan(points)
    plain = symsurf.detect(points, method)
    with pytest.warns(
        symsurf.InputWarning, match=f"{len(given) - len(points)} points are not"
    ) as w:
        result = symsurf.detect(given, method)
    assert w[0].filename == __file__
    assert result.statistics["nonfinite_points"] == len(given) - len(points)
    assert repr(result.mirror) == repr(plain.mirror) and result.score == plain.score
    np.testing.assert_array_equal(result.pairs, keep[plain.pairs])
    np.testing.assert_array_equal(result.residuals, plain.residuals)
    assert len(result.points) == len(given)


def test_points_that_are_not_finite_keep_their_places_in_operations():
    points, _ = mirrored_surface(400, 3)
    given, keep = with_nan(points)
    with pytest.warns(symsurf.InputWarning, match="points are not finite"):
        found = symsurf.asymmetry(given)
    plain = symsurf.asymmetry(points)
    assert found.statistics["nonfinite_points"] == len(given) - len(points)
    np.testing.assert_array_equal(found.vector[keep], plain.vector)
    lost = np.setdiff1d(np.arange(len(given)), keep)
    assert np.isnan(found.vector[lost]).all() and not found.matched[lost].any()
    completed = symsurf.complete(given, found.mirror)
    np.testing.assert_array_equal(completed.shape.points[: len(given)], given)
    assert np.isfinite(completed.shape.points[len(given) :]).all()


def test_every_way_in_warns(tmp_path):
    points, mirror = mirrored_surface(400, 3)
    points[5, 1] = np.inf
    path = off(tmp_path / "scan.off", points)
    for call in (
        lambda: symsurf.detect_plane(points),
        lambda: symsurf.detect(path, "plane"),
        lambda: symsurf.match(points, mirror),
    ):
        with pytest.warns(symsurf.InputWarning, match="1 point is not finite: it is left out") as w:
            result = call()
        assert w[0].filename == __file__ and result.statistics["nonfinite_points"] == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "nonfinite_points" not in symsurf.detect_plane(np.delete(points, 5, 0)).statistics


def test_a_method_warns_of_what_it_is_not_for():
    points, _ = mirrored_surface(10_002, 3)
    with pytest.warns(symsurf.InputWarning, match="10002 points given; sphere_thesis is for") as w:
        result = symsurf.detect(points, "sphere_thesis", sample_size=10)
    assert w[0].filename == __file__ and result.statistics["warning"] == str(w[0].message)


def test_pictures_and_files_of_such_results(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    points, _ = mirrored_surface(400, 3)
    given, _ = with_nan(points)
    with pytest.warns(symsurf.InputWarning):
        result = symsurf.detect(given, "plane")
    for suffix in ("json", "vtp", "ply", "txt"):
        result.save(tmp_path / f"result.{suffix}")
    assert np.isfinite(pyvista.read(tmp_path / "result.vtp").length)


def test_the_command_line_says_so_in_one_line(tmp_path):
    points, _ = mirrored_surface(400, 3)
    points[5] = np.nan
    path = off(tmp_path / "scan.off", points)
    done = run("detect", path, "--method", "plane")
    assert done.returncode == 0 and len(done.stderr.splitlines()) == 1
    assert str(path) in done.stderr and "1 point is not finite" in done.stderr
    done = run("detect", path, "--method", "plane", "--downsample", "2")
    assert done.returncode == 0 and "1 point is not finite" in done.stderr
    done = run("detect", path, "--nonfinite", "refuse")
    assert done.returncode == 1 and "point 5 is (nan, nan, nan)" in done.stderr
    assert run("detect", path, "--nonfinite", "drop").returncode == 2


# Files


def test_a_file_is_read(tmp_path):
    points, faces, normal, on = chair(1)
    path = off(tmp_path / "chair.off", points, faces)
    result, plain = symsurf.detect(path, "plane"), symsurf.detect(str(path), "plane")
    assert is_near(result.mirror, normal, on)
    assert repr(result.mirror) == repr(plain.mirror)
    np.testing.assert_array_equal(result.points, points)
    np.testing.assert_array_equal(result.faces, faces)
    record = run("detect", path, "--method", "plane", "--json").stdout
    assert f'"score": {result.score!r}' in record and '"surface_samples"' in record
    record = run("detect", path, "--method", "plane", "--ignore-faces", "--json").stdout
    assert '"surface_samples"' not in record


# Meshes


def shapes_of(points, faces):
    """The same mesh as everything that detect takes for one."""
    yield {"points": points, "faces": faces}
    yield {"points": points.tolist(), "faces": faces.tolist()}
    yield {"points": points, "faces": faces.astype(np.uint32)}
    yield {"points": symsurf.Shape(points, faces)}
    yield {"points": SimpleNamespace(vertices=points, faces=faces)}
    yield {"points": SimpleNamespace(points=points, triangles=faces.astype(np.int32))}
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.PolyData.from_regular_faces(points, faces)
    yield {"points": mesh}
    yield {"points": mesh.cast_to_unstructured_grid()}


@each_seed
def test_faces_find_the_mirror_of_a_chair(seed):
    points, faces, normal, on = chair(seed)
    results = [symsurf.detect(method="plane", **given) for given in shapes_of(points, faces)]
    first = results[0]
    assert is_near(first.mirror, normal, on) and first.score > 0.9 and first.verdict == "found"
    assert first.statistics["surface_samples"] > 10000
    assert len(first.pairs) == len(points) and first.pairs.max() < len(points)
    for result in results:
        assert repr(result.mirror) == repr(first.mirror) and result.score == first.score
        np.testing.assert_array_equal(result.faces, faces)
        np.testing.assert_array_equal(result.pairs, first.pairs)


def test_faces_count_for_a_known_mirror():
    points, faces, *_ = chair(0)
    shape = symsurf.Shape(points, faces)
    found = symsurf.detect(shape, "plane")
    matched = symsurf.match(shape, found)
    assert matched.verdict == found.verdict
    assert matched.score == pytest.approx(found.score, abs=1e-12)
    np.testing.assert_array_equal(matched.pairs, found.pairs)


def test_faces_can_be_left_aside():
    points, faces, *_ = chair(0)
    plain = symsurf.detect(points, "plane")
    result = symsurf.detect(symsurf.Shape(points, faces), "plane", use_faces=False)
    assert repr(result.mirror) == repr(plain.mirror) and result.score == plain.score
    assert plain.faces is None
    np.testing.assert_array_equal(result.faces, faces)  # for pictures


def test_polygons_are_divided():
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.Box((0, 1, 0, 2, 0, 3))  # of quads
    result = symsurf.detect(mesh, "plane")
    assert result.faces.shape == (12, 3) and result.statistics["surface_samples"] > 10000
    assert np.abs(result.mirror.normal).max() > 0.9999


def test_solid_cells_have_an_outer_surface(tmp_path):
    """Whatever their kind; points inside belong to no face."""
    pyvista = pytest.importorskip("pyvista")
    bricks = pyvista.ImageData(dimensions=(4, 5, 6)).cast_to_unstructured_grid()
    tetrahedra = pyvista.ImageData(dimensions=(4, 5, 6)).to_tetrahedra()
    for grid in bricks, tetrahedra:
        grid.save(tmp_path / "body.vtu")
        shape = symsurf.read(tmp_path / "body.vtu")
        corners = shape.points[shape.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert len(shape.points) == grid.n_points
        assert np.linalg.norm(normals, axis=1).sum() / 2 == pytest.approx(2 * (12 + 15 + 20))
        assert abs(np.einsum("ij,ij->", corners[:, 0], normals) / 6) == pytest.approx(60)


def test_cells_that_name_no_point():
    """In a process of its own: VTK would read beside the points."""
    pytest.importorskip("pyvista")
    done = subprocess.run(
        [sys.executable, "-c", BROKEN_CELLS], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    said = [f"a cell names point {corner}; there are 50 points" for corner in (-1, 50, 10**6)]
    assert done.stdout.splitlines() == 4 * [each for each in said for _ in range(5)]


BROKEN_CELLS = """
import numpy as np
import pyvista
import symsurf

points = np.random.default_rng(0).normal(size=(50, 3))
plane = symsurf.Plane((1, 0, 0), 0)


def use_all(mesh, grid):
    mesh.symmetry.result = symsurf.match(points, plane)
    yield lambda: symsurf.detect(mesh)
    yield lambda: symsurf.detect(grid)
    yield lambda: symsurf.Shape.from_pyvista(mesh)
    yield lambda: plane.reflect(mesh)
    yield lambda: mesh.symmetry.complete(faces=[[0, 1, 2], [1, 2, 3]])


for kind in ("faces", "strips", "lines", "verts"):
    for corner in (-1, 50, 10**6):
        cell = [0, 1, 2, corner]
        mesh = pyvista.PolyData(points, **{kind: [4, *cell]})
        grid = pyvista.UnstructuredGrid(np.array([4, *cell]), [pyvista.CellType.QUAD], points)
        for use in use_all(mesh, grid):
            try:
                use()
            except symsurf.InvalidInput as error:
                print(error)
"""


def test_a_curved_structured_grid_is_a_mesh():
    pyvista = pytest.importorskip("pyvista")
    x, y = np.meshgrid(np.linspace(-1, 1, 20), np.linspace(-2, 3, 30), indexing="ij")
    sheet = pyvista.StructuredGrid(x, y, 0.3 * x**2 + 0.1 * y**3)
    result = symsurf.detect(sheet, "plane")
    assert len(result.faces) == 2 * 19 * 29 and len(result.points) == 600
    assert is_near(result.mirror, np.array([1.0, 0, 0]), np.zeros(3))


def test_other_objects_are_as_they_were():
    points, _ = mirrored_surface(400, 0)
    for given in (points, points.tolist(), SimpleNamespace(points=points)):
        result = symsurf.detect(given, "plane")
        assert result.faces is None and repr(result.mirror) == repr(
            symsurf.detect_plane(points).mirror
        )


def test_blocks_are_to_be_combined():
    pyvista = pytest.importorskip("pyvista")
    blocks = pyvista.MultiBlock([pyvista.Sphere(center=(2, 0, 0)), pyvista.Cube()])
    with pytest.raises(symsurf.InvalidInput, match="has 2 blocks; allowed is one of them"):
        symsurf.detect(blocks)


def test_a_grid_has_no_other_points():
    pyvista = pytest.importorskip("pyvista")
    image = pyvista.ImageData(dimensions=(6, 6, 6))
    image["mask"] = np.arange(216) % 6 > 2
    found = symsurf.asymmetry(image, symsurf.Plane((1, 0, 0), -4))
    with pytest.raises(symsurf.InvalidInput, match="ImageData is a regular grid"):
        found.like(image)
