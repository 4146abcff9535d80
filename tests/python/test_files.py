"""Reading shapes, and saving results in every format."""

from __future__ import annotations

import json

import numpy as np
import pytest
from symmetric_shapes import quick

import symsurf

SUFFIXES = ".json", ".vtp", ".ply", ".txt"


@pytest.fixture
def result(blob):
    return symsurf.match(np.vstack([blob, blob * (-1, 1, 1)]), symsurf.Plane((2, 0, 0), 0))


def test_read_keeps_every_digit(tmp_path, blob):
    path = tmp_path / "far.xyz"
    path.write_text("\n".join(" ".join(map(repr, row)) for row in (blob + 4e6).tolist()))
    shape = symsurf.read(str(path))
    np.testing.assert_array_equal(shape.points, blob + 4e6)
    assert shape.faces is None and shape.normals is None
    assert f"{len(blob)} points, no faces" in repr(shape)


def test_read_mesh(tmp_path):
    path = tmp_path / "square.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    shape = symsurf.read(path)
    assert shape.points.shape == (4, 3) and shape.points.dtype == np.float64
    assert shape.faces.tolist() == [[0, 1, 2], [0, 2, 3]] and shape.faces.dtype == np.int64


@pytest.mark.parametrize(
    ("name", "content"),
    [("none.ply", None), ("empty.ply", ""), ("broken.obj", "v 1 2"), ("scan.docx", "1 2 3")],
)
def test_read_names_the_file_and_the_reason(tmp_path, name, content):
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(symsurf.InvalidInput, match=name):
        symsurf.read(tmp_path / name)


def test_json(result, tmp_path):
    result.save(tmp_path / "result.json")
    saved = json.loads((tmp_path / "result.json").read_text())
    assert saved["method"] == result.method and saved["score"] == result.score
    assert saved["mirror"] == {"kind": "plane", "normal": [1, 0, 0], "offset": 0}
    assert saved["parameters"] == result.parameters
    for name in ("pairs", "residuals", "surface_points"):
        np.testing.assert_array_equal(saved[name], getattr(result, name))


def test_json_knows_no_nan(blob, tmp_path):
    result = symsurf.detect(blob)
    result.statistics.update(nothing=np.nan, rows=np.array([[1, np.inf]]), flag=True)
    result.save(tmp_path / "result.json")
    saved = json.loads((tmp_path / "result.json").read_text(), parse_constant=pytest.fail)
    assert saved["statistics"]["nothing"] is None
    assert saved["statistics"]["rows"] == [[1, None]]
    assert len(saved["candidates"]) == len(result.candidates)


def test_text_is_the_thesis_format(result, tmp_path):
    result.save(tmp_path / "result.txt")
    np.testing.assert_array_equal(
        np.loadtxt(tmp_path / "result.txt", delimiter=",", comments="#"), result.surface_points
    )
    lines = (tmp_path / "result.txt").read_text().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    assert lines[: len(comments)] == comments
    assert "# mirror plane" in comments and "# normal 1.0,0.0,0.0" in comments


def test_text_of_a_sphere_is_centre_and_radius(blob, tmp_path):
    symsurf.match(blob, symsurf.Sphere((1, 2, 3), 9.5)).save(tmp_path / "sphere.txt")
    lines = (tmp_path / "sphere.txt").read_text().splitlines()
    assert [line for line in lines if not line.startswith("#")] == ["1.0,2.0,3.0", "9.5"]


def test_ply(result, tmp_path):
    result.save(tmp_path / "result.ply")
    np.testing.assert_array_equal(
        symsurf.read(tmp_path / "result.ply").points, result.surface_points
    )
    header, _, data = (tmp_path / "result.ply").read_bytes().partition(b"end_header\n")
    assert b"property double quality" in header
    rows = np.frombuffer(data, "<f8").reshape(-1, 4)
    np.testing.assert_array_equal(rows[:, 3], result.residuals)


def test_vtp(result, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    result.save(tmp_path / "result.vtp")
    saved = pyvista.read(tmp_path / "result.vtp")
    count = len(result.pairs)
    vertices, triangles = result.mirror.mesh(result.points)
    np.testing.assert_array_equal(saved.points, np.vstack([result.surface_points, vertices]))
    np.testing.assert_array_equal(saved.regular_faces, triangles + count)
    np.testing.assert_array_equal(saved.verts.reshape(-1, 2)[:, 1], range(count))
    np.testing.assert_array_equal(saved["Residual"][:count], result.residuals)
    assert np.isnan(saved["Residual"][count:]).all()
    np.testing.assert_array_equal(saved["MirrorPoint"][:count], result.pairs[:, 0])
    np.testing.assert_array_equal(saved["MirrorPartner"][:count], result.pairs[:, 1])
    assert saved.field_data["Kind"][0] == "plane"
    np.testing.assert_array_equal(saved.field_data["Normal"], [(1, 0, 0)])


def test_vtp_keeps_the_rows_of_tables(tmp_path, blob):
    pyvista = pytest.importorskip("pyvista")
    nodes = np.column_stack([blob[:20, :2], np.zeros(20)])
    mirror = symsurf.HeightField((0, 0, 1), nodes)
    symsurf.match(blob, mirror).save(tmp_path / "result.vtp")
    saved = pyvista.read(tmp_path / "result.vtp")
    np.testing.assert_array_equal(saved.field_data["Nodes"], nodes)


@pytest.mark.parametrize("method", symsurf.methods())
def test_every_method_in_every_format(method, blob, tmp_path):
    result = symsurf.detect(blob, method, **quick(method))
    names = {f"result{suffix}" for suffix in SUFFIXES}
    for name in names:
        result.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 0
    assert {file.name for file in tmp_path.iterdir()} == names


@pytest.mark.parametrize("suffix", [".vtp", ".ply"])
def test_mirror_that_maps_no_point_is_saved_without_triangles(suffix, blob, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    symsurf.match(blob, symsurf.Sphere((50, 0, 0), 1)).save(tmp_path / f"result{suffix}")
    saved = pyvista.read(tmp_path / f"result{suffix}")
    assert saved.n_points == saved.n_cells == 0


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_without_any_pair(suffix, blob, tmp_path):
    far = symsurf.match(blob, symsurf.Plane((1, 0, 0), 1000))
    assert len(far.pairs) == 0 and far.surface_points.shape == (0, 3)
    far.save(tmp_path / f"result{suffix}")


def test_other_suffixes_are_refused(result, tmp_path):
    with pytest.raises(symsurf.InvalidParameter, match=r"result\.docx.*\.json, \.vtp"):
        result.save(tmp_path / "result.docx")
    assert not list(tmp_path.iterdir())


def test_nothing_is_half_written(result, tmp_path):
    path = tmp_path / "result.json"
    path.write_text("precious")
    result.statistics["strange"] = object()  # cannot be written
    with pytest.raises(TypeError):
        result.save(path)
    assert path.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(OSError, match="nowhere"):
        result.save(tmp_path / "nowhere" / "result.txt")


def test_a_folder_in_the_way(result, tmp_path):
    (tmp_path / "result.txt").mkdir()
    with pytest.raises(OSError):
        result.save(tmp_path / "result.txt")
    assert [path.name for path in tmp_path.iterdir()] == ["result.txt"]
