"""One label of many, and which way the axes of a file point."""

from __future__ import annotations

import json

import nibabel
import nrrd
import numpy as np
import pytest
from command_line import run, run_here
from dialects import images
from symmetric_shapes import mirrored_surface

import symsurf

LABELS = np.zeros((9, 8, 7), np.int16)
LABELS[1:4, 1:5, 1:3] = 3
LABELS[5:8, 2:7, 3:6] = 12
AXES = np.diag([1.0, 2, 3, 1])


@pytest.fixture(params=["map.nii", "map.nrrd", "map.vti"])
def label_map(request, tmp_path):
    path = tmp_path / request.param
    if path.suffix == ".nii":
        nibabel.Nifti1Image(LABELS, AXES).to_filename(path)
    elif path.suffix == ".nrrd":
        nrrd.write(str(path), LABELS, {"space directions": AXES[:3, :3], "space": "RAS"})
    else:
        pyvista = pytest.importorskip("pyvista")
        image = pyvista.ImageData(dimensions=LABELS.shape, spacing=(1, 2, 3))
        image["label"] = LABELS.ravel("F")
        image.save(path)
    return path


def by_position(points):
    return points[np.lexsort(points.T)]


@pytest.mark.parametrize("label", [3, 12])
def test_a_label_of_a_map(label, label_map):
    expected = by_position(np.argwhere(LABELS == label) * (1.0, 2, 3))
    points = symsurf.read(label_map, label=label).points
    np.testing.assert_array_equal(by_position(points), expected)
    done = run("detect", label_map, "--label", label, "--method", "plane", "--json")
    assert json.loads(done.stdout)["points"] == len(expected)
    rows = list(symsurf.batch([label_map], method="plane", label=label))
    assert rows[0]["points"] == len(expected) and rows[0]["error"] == ""


def test_labels_that_are_none(label_map):
    with pytest.raises(symsurf.InvalidInput, match="label=4; there are 0, 3, 12"):
        symsurf.read(label_map, label=4)
    with pytest.raises(symsurf.InvalidParameter, match="beside a threshold"):
        symsurf.read(label_map, label=3, threshold=0)
    with pytest.raises(symsurf.InvalidInput, match="or label=NUMBER"):
        symsurf.read(label_map)
    with pytest.raises((symsurf.InvalidParameter, symsurf.InvalidInput), match="'liver'"):
        symsurf.read(label_map, label="liver")


def test_a_label_of_what_is_no_image(tmp_path):
    (tmp_path / "cloud.xyz").write_text("0 0 0\n1 0 0\n")
    with pytest.raises(symsurf.InvalidParameter, match="label is 1; allowed is None"):
        symsurf.read(tmp_path / "cloud.xyz", label=1)


def test_segments_in_layers(tmp_path):
    path = tmp_path / "two.seg.nrrd"
    path.write_bytes(images.LAYERED)
    for name, voxels in {"left": (0, 1), "right": (1, 1), "tip": (1, 2)}.items():
        layer, label = voxels
        chosen = np.argwhere(images._TWO[layer] == label)
        expected = chosen @ images.AFFINE[:3, :3].T + images.AFFINE[:3, 3]
        points = symsurf.read(path, label=name).points
        np.testing.assert_allclose(by_position(points), by_position(expected))
    assert len(symsurf.read(path, label=2).points) == 1
    with pytest.raises(symsurf.InvalidInput, match="'heart'; there are 'left', 'right', 'tip'"):
        symsurf.read(path, label="heart")


def cloud(tmp_path, name, content):
    points, _ = mirrored_surface(80, 0)
    path = tmp_path / name
    path.write_text(content(points.tolist()))
    return path


def rows_of(points, joint):
    return "\n".join(joint.join(map(repr, row)) for row in points) + "\n"


WRITERS = {
    "a.xyz": lambda points: "# SPACE=LPS\n" + rows_of(points, " "),
    "a.obj": lambda points: "# SPACE=LPS\nv " + rows_of(points, " ").strip().replace("\n", "\nv "),
    "a.fcsv": lambda points: (
        "# Markups fiducial file version = 4.11\n# CoordinateSystem = LPS\n# columns = x,y,z\n"
        + rows_of(points, ",")
    ),
    "b.fcsv": lambda points: (
        "# CoordinateSystem = 1\n# columns = x,y,z,label\n"
        + rows_of(points, ",").replace("\n", ",F\n")
    ),
    "a.vtk": lambda points: (
        f"# vtk DataFile Version 3.0\nSPACE=LPS\nASCII\nDATASET POLYDATA\nPOINTS {len(points)} "
        "double\n" + rows_of(points, " ")
    ),
}


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize("words", ["--frame ras", "--frame lps", "--format ply", "--format vtp"])
def test_axes_are_kept_or_named(name, words, tmp_path):
    path = cloud(tmp_path, name, WRITERS[name])
    assert symsurf.read(path).space == "LPS"
    done = run_here(f"align {name} --method plane {words} --output made", tmp_path)
    assert done.returncode == 0, done.stderr
    (made,) = (tmp_path / "made").iterdir()
    assert symsurf.read(made).space == ("RAS" if words.endswith("ras") else "LPS")


@pytest.mark.parametrize("suffix", [".ply", ".vtp"])
def test_axes_of_images_go_along(suffix, tmp_path):
    voxels = np.zeros((9, 9, 9), np.uint8)
    voxels[1:8, 2:7, 2:5] = 1
    nibabel.Nifti1Image(voxels, AXES).to_filename(tmp_path / "mask.nii")
    shape = symsurf.read(tmp_path / "mask.nii")
    assert shape.space == "RAS"
    made = symsurf.symmetrize(shape, symsurf.Plane((1, 0, 0), -4))
    assert made.shape.space == made.given.space == "RAS"
    made.save(tmp_path / f"made{suffix}")
    assert symsurf.read(tmp_path / f"made{suffix}").space == "RAS"
    bare = symsurf.Shape(shape.points)
    symsurf.symmetrize(bare, symsurf.Plane((1, 0, 0), -4)).save(tmp_path / f"bare{suffix}")
    assert symsurf.read(tmp_path / f"bare{suffix}").space is None


@pytest.mark.parametrize("space", ["RAS", "LPS", None])
def test_a_saved_result_names_its_axes(space, tmp_path):
    points, mirror = mirrored_surface(80, 0)
    shape = symsurf.Shape(points, space=space)
    for result in (symsurf.detect(shape, "plane"), symsurf.match(shape, mirror)):
        assert result.space == space
        for suffix in (".ply", ".vtp", ".txt"):
            result.save(tmp_path / f"result{suffix}")
            assert symsurf.read(tmp_path / f"result{suffix}").space == space
        result.save(tmp_path / "result.json")
        assert symsurf.Result.load(tmp_path / "result.json").space == space
        assert all(candidate.space == space for candidate in result.candidates)
    record = json.loads((tmp_path / "result.json").read_text())
    (tmp_path / "result.json").write_text(json.dumps(record | {"space": "RAI"}))
    with pytest.raises(symsurf.InvalidInput, match="space is 'RAI'; allowed are 'RAS', 'LPS'"):
        symsurf.Result.load(tmp_path / "result.json")


def test_an_image_without_axes_has_none(tmp_path):
    image = nibabel.Nifti1Image(np.eye(4, dtype=np.uint8)[None], None)
    image.header["sform_code"] = image.header["qform_code"] = 0
    image.to_filename(tmp_path / "mask.nii")
    assert symsurf.read(tmp_path / "mask.nii").space is None
