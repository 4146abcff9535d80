"""What results are saved as: by the suffix, with what the file of the shape holds."""

from __future__ import annotations

import json
import shutil
import warnings

import numpy as np
import pytest
from attributed_files import obj
from command_line import run_here

import symsurf

PLANE = symsurf.Plane((1, 0, 0), 0.0)
MESHES = (".stl", ".obj", ".off", ".ply", ".glb")


@pytest.fixture
def wedge():
    """A roof, mirrored in x, far from the origin of the other axes."""
    points = np.array([[x, y, z] for x in (-1.5, 1.5) for y in (0, 2) for z in (0, 1)], float)
    points = np.vstack([points, [[0, 0, 1.7], [0, 2, 1.7]]]) + (0, 1000, -50)
    faces = [[0, 2, 4], [4, 2, 6], [1, 8, 3], [8, 9, 3], [5, 7, 8], [7, 9, 8], [0, 1, 3], [0, 3, 2]]
    return symsurf.Shape(points, np.array([*faces, [4, 7, 5], [4, 6, 7]]))


def corners(shape):
    return shape.points[shape.faces]


@pytest.mark.parametrize("suffix", MESHES)
def test_shapes_go_round(suffix, wedge, tmp_path):
    made = symsurf.symmetrize(wedge, PLANE)
    with warnings.catch_warnings(record=True):
        warnings.simplefilter("always")
        made.save(tmp_path / f"made{suffix}")
    again = symsurf.read(tmp_path / f"made{suffix}")
    # GLB rounds to single precision, within the box of the shape.
    allowed = 1e-6 if suffix == ".glb" else 0
    np.testing.assert_allclose(corners(again), corners(made.shape), rtol=0, atol=allowed)


@pytest.mark.parametrize("suffix", MESHES)
def test_what_a_file_does_not_hold_is_warned_of(suffix, wedge, tmp_path):
    found = symsurf.asymmetry(wedge, PLANE)
    if suffix in (".ply", ".glb"):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found.save(tmp_path / f"made{suffix}")
    else:
        with pytest.warns(
            symsurf.InputWarning, match="cannot hold the arrays vector, distance"
        ) as given:
            found.save(tmp_path / f"made{suffix}")
        assert [each.filename for each in given] == [__file__]


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".off", ".glb"])
def test_mirrors_are_meshes(suffix, wedge, tmp_path):
    found = symsurf.match(wedge, PLANE)
    found.save(tmp_path / f"mirror{suffix}")
    mirror = symsurf.read(tmp_path / f"mirror{suffix}")
    assert len(mirror.faces) >= 1 and np.abs(mirror.points[:, 0]).max() < 1e-12
    none = symsurf.Result.from_fields(vars(found) | {"mirror": None})
    with pytest.raises(symsurf.InvalidInput, match="no mirror to write as"):
        none.save(tmp_path / f"none{suffix}")


def test_glb_is_what_others_read(wedge, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    found = symsurf.asymmetry(wedge, PLANE)
    found.save(tmp_path / "made.glb")
    mesh = trimesh.load(tmp_path / "made.glb", force="mesh", process=False)
    np.testing.assert_allclose(mesh.vertices, wedge.points, rtol=0, atol=1e-6)
    np.testing.assert_array_equal(mesh.faces, wedge.faces)
    symsurf.asymmetry(wedge.points, PLANE).save(tmp_path / "cloud.glb")
    cloud = symsurf.read(tmp_path / "cloud.glb")
    assert cloud.faces is None or not len(cloud.faces)
    np.testing.assert_allclose(cloud.points, wedge.points, rtol=0, atol=1e-6)


QUADS = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3]]


@pytest.fixture
def attributed(wedge, tmp_path):
    path = tmp_path / "box.obj"
    normals = np.tile([0.0, 0.0, 1.0], (8, 1))
    path.write_bytes(obj(wedge.points[:8], QUADS, normals))
    (tmp_path / "box.mtl").write_text("newmtl wood\n")
    return path


@pytest.mark.parametrize("given", ["path", "shape"])
def test_a_file_keeps_what_it_holds(given, attributed, tmp_path):
    shape = attributed if given == "path" else symsurf.read(attributed)
    made = symsurf.straighten(shape, PLANE)
    made.save(tmp_path / "made.obj")
    before, after = attributed.read_bytes().split(), (tmp_path / "made.obj").read_bytes().split()
    for word in (b"usemtl", b"mtllib", b"vt", b"f"):
        assert before.count(word) == after.count(word) > 0
    np.testing.assert_array_equal(symsurf.read(tmp_path / "made.obj").points, made.shape.points)


def test_a_file_that_is_gone_is_written_anew(attributed, tmp_path):
    made = symsurf.straighten(attributed, PLANE)
    attributed.unlink()
    with pytest.warns(symsurf.InputWarning, match="nothing of the file is kept but points and"):
        made.save(tmp_path / "made.obj")
    after = symsurf.read(tmp_path / "made.obj")
    np.testing.assert_array_equal(after.points, made.shape.points)


def test_one_input_and_a_suffix_are_a_file(attributed, tmp_path):
    (tmp_path / "mirror.json").write_text(
        json.dumps({"mirror": {"kind": "plane", "normal": [1, 0, 0], "offset": 0}})
    )
    for suffix in MESHES:
        done = run_here(f"align box.obj --mirror mirror.json -o made{suffix}", tmp_path)
        assert done.returncode == 0 and done.stdout.splitlines()[-1] == f"  written   made{suffix}"
        assert len(symsurf.read(tmp_path / f"made{suffix}").faces) == 8
    done = run_here("align box.obj --mirror mirror.json -o made/new.v2 --json", tmp_path)
    assert json.loads(done.stdout)["written"] == ["made/new.v2/box.obj"]
    shutil.copy(attributed, tmp_path / "other.obj")
    done = run_here("align box.obj other.obj --mirror mirror.json -o both.obj", tmp_path)
    assert sorted(path.name for path in (tmp_path / "both.obj").iterdir()) == [
        "box.obj",
        "other.obj",
    ]
    done = run_here("detect box.obj -o both.obj", tmp_path)  # a folder that is there
    assert (tmp_path / "both.obj" / "box.summary.json").exists()


def test_detections_and_analyses_write_a_file_too(attributed, tmp_path):
    for line, name in [
        ("detect box.obj --method plane", "mirror.stl"),
        ("detect box.obj --method plane", "new/found.json"),
        ("detect box.obj --method plane", "found.summary.json"),
        ("symmetries box.obj", "group.json"),
        ("symmetries box.obj", "box.glb"),
    ]:
        done = run_here(f"{line} -o {name}", tmp_path)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / name).is_file() and f"written   {name}" in done.stdout
    assert symsurf.Result.load(tmp_path / "new/found.json").mirror.kind == "plane"


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("align box.obj -o box.obj", "box.obj would overwrite an input"),
        ("align box.obj -o made.stl --format ply", "'made.stl', a file, whose suffix says"),
        ("detect box.obj -o made.off --formats json", "'made.off', a file, whose suffix says"),
        ("detect box.obj -o made.xyz", "allowed are a folder and files that end in"),
        ("symmetries box.obj -o made.mirror", "allowed are a folder and files that end in"),
    ],
)
def test_outputs_that_are_refused(line, says, attributed, tmp_path):
    done = run_here(line, tmp_path)
    assert done.returncode == 2 and says in done.stderr and done.stdout == ""
    assert sorted(path.name for path in tmp_path.iterdir()) == ["box.mtl", "box.obj"]
