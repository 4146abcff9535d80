"""Formats that other libraries write: what their files hold is kept, and what is wrong with them is
said."""

from __future__ import annotations

import gzip
import json
import subprocess
import sys

import numpy as np
import pytest
from command_line import run, run_here
from conftest import ROOT
from symmetric_shapes import difference, mirrored_surface

import symsurf
from symsurf.reading.formats import FORMATS
from symsurf.reading.splat import SPLAT

pyvista = pytest.importorskip("pyvista")
trimesh = pytest.importorskip("trimesh")
laspy = pytest.importorskip("laspy")
nrrd = pytest.importorskip("nrrd")
nibabel = pytest.importorskip("nibabel")
pypcd4 = pytest.importorskip("pypcd4")

# Every coordinate is a whole number of 1/64: single precision holds it, as glTF has no other.
POINTS = np.random.default_rng(3).integers(-500, 500, (40, 3)) / 64
FACES = np.arange(39).reshape(-1, 3)
AFFINE = np.array([[0, -2, 0, 10], [1.5, 0, 0, -20], [0, 0.5, 3, 30], [0, 0, 0, 1]])


def mask() -> np.ndarray:
    voxels = np.zeros((6, 7, 8), np.uint8)
    voxels[1:3, 2:5, 3:7] = 1
    voxels[4, 5, 6] = 1
    return voxels


def chosen(voxels: np.ndarray, affine: np.ndarray = AFFINE) -> np.ndarray:
    return np.argwhere(voxels) @ affine[:3, :3].T + affine[:3, 3]


def write_poly_data(path):
    pyvista.PolyData.from_regular_faces(POINTS, FACES).save(path)


def write_unstructured(path):
    pyvista.PolyData.from_regular_faces(POINTS, FACES).cast_to_unstructured_grid().save(path)


def write_image(path):
    voxels = mask()
    image = pyvista.ImageData(dimensions=voxels.shape, spacing=(2, 3, 4), origin=(1, 2, 3))
    image["mask"] = voxels.ravel("F")
    image.save(path)


def write_mesh(path):
    trimesh.Trimesh(POINTS, FACES, process=False).export(path)


def write_gltf(path):
    files = trimesh.Trimesh(POINTS, FACES, process=False).export(file_type="gltf")
    for name, content in files.items():
        (path if name.endswith(".gltf") else path.with_name(name)).write_bytes(content)


def write_las(path):
    scan = laspy.create()
    scan.header.scales, scan.header.offsets = [1 / 64] * 3, [4e6, -5e5, 0]
    scan.xyz = POINTS + scan.header.offsets
    scan.write(path)


def write_pcd(path):
    pypcd4.PointCloud.from_xyz_points(POINTS.astype("f4")).save(path)


def write_splat(path):
    table = np.zeros(len(POINTS), SPLAT)
    table["position"] = POINTS
    path.write_bytes(table.tobytes())


def write_nrrd(path):
    header = {"space": "left-posterior-superior", "space origin": AFFINE[:3, 3]}
    nrrd.write(str(path), mask(), header | {"space directions": AFFINE[:3, :3].T})


def write_nifti(path):
    nibabel.Nifti1Image(mask(), AFFINE).to_filename(path)


FAR = POINTS + (4e6, -5e5, 0)
OF_IMAGE = chosen(mask(), np.array([[2, 0, 0, 1], [0, 3, 0, 2], [0, 0, 4, 3], [0, 0, 0, 1]]))
# What writes a file, its points and its faces.
WRITTEN = {
    ".vtp": (write_poly_data, POINTS, FACES),
    ".vtk": (write_poly_data, POINTS, FACES),
    ".vtu": (write_unstructured, POINTS, FACES),
    ".vti": (write_image, OF_IMAGE, None),
    ".glb": (write_mesh, POINTS, FACES),
    ".gltf": (write_gltf, POINTS, FACES),
    ".3mf": (write_mesh, POINTS, FACES),
    ".las": (write_las, FAR, None),
    ".laz": (write_las, FAR, None),
    ".pcd": (write_pcd, POINTS, None),
    ".splat": (write_splat, POINTS, None),
    ".nrrd": (write_nrrd, chosen(mask()), None),
    ".nii": (write_nifti, chosen(mask()), None),
}


def by_position(points: np.ndarray) -> np.ndarray:
    return points[np.lexsort(points.round(6).T)]


def test_every_format_of_others_is_tested():
    assert set(WRITTEN) == {suffix for suffix, each in FORMATS.items() if each.reader != "own"}


@pytest.mark.parametrize("suffix", WRITTEN)
def test_what_a_library_wrote(suffix, tmp_path):
    write, points, faces = WRITTEN[suffix]
    path = tmp_path / f"shape{suffix}"
    write(path)
    shape = symsurf.read(path)
    assert shape.points.dtype == np.float64
    if faces is None:
        assert shape.faces is None
        np.testing.assert_allclose(by_position(shape.points), by_position(points), rtol=1e-14)
    else:  # a format may order and leave out points as it likes, not change the triangles
        assert shape.faces.dtype == np.int64
        np.testing.assert_array_equal(shape.points[shape.faces], points[faces])
    if suffix == ".gltf":  # which names another file beside it
        return
    packed = tmp_path / f"packed{suffix.upper()}.gz"
    packed.write_bytes(gzip.compress(path.read_bytes()))
    for same in (symsurf.read(packed), symsurf.read(path.open("rb"), suffix[1:])):
        np.testing.assert_array_equal(same.points, shape.points)


@pytest.mark.parametrize("suffix", WRITTEN)
@pytest.mark.parametrize("kind", ["half", "text", "nothing"])
def test_broken_files_are_named_with_the_reason(suffix, kind, tmp_path, capfd):
    path = tmp_path / f"shape{suffix}"
    WRITTEN[suffix][0](path)
    content = path.read_bytes()
    broken = {"half": content[: len(content) // 2 | 1], "text": b"no shape\n" * 9, "nothing": b""}
    path.write_bytes(broken[kind])
    with pytest.raises(symsurf.InvalidInput) as error:
        symsurf.read(path)
    message = str(error.value)
    assert message.startswith(f"{path}: ") and len(message) > len(f"{path}: ") + 5
    assert "\n" not in message
    assert capfd.readouterr().err == ""  # VTK would print


@pytest.mark.parametrize("suffix", [suffix for suffix in WRITTEN if FORMATS[suffix].packages])
def test_without_the_package_one_sentence_says_what_brings_it(suffix, tmp_path, monkeypatch):
    path = tmp_path / f"shape{suffix}"
    WRITTEN[suffix][0](path)
    described = FORMATS[suffix]
    monkeypatch.setitem(sys.modules, described.packages[-1], None)
    with pytest.raises(symsurf.InvalidInput) as error:
        symsurf.read(path)
    assert str(error.value) == (
        f"{path}: {described.name} needs the package {described.packages[-1]}, which is not "
        f"installed: pip install 'symsurf[{described.extra}]'"
    )


def test_the_package_itself_imports_none_of_them():
    names = {package for each in FORMATS.values() for package in each.packages}
    code = f"import sys, symsurf; print([n for n in {sorted(names)!r} if n in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_extras_and_documents_name_every_format():
    project = (ROOT / "pyproject.toml").read_text()
    page = (ROOT / "docs/command_line.md").read_text()
    for suffix, each in FORMATS.items():
        assert not each.extra or f"\n{each.extra} = [" in project
        assert suffix[1:].upper() in page and suffix[1:].upper() in (symsurf.read.__doc__ or "")
    told = run("detect", "--help").stdout.replace("\n", " ")
    assert all(each.name in told for each in FORMATS.values())


def test_parts_of_a_scene_are_where_the_scene_has_them(tmp_path):
    part = trimesh.Trimesh(POINTS, FACES, process=False)
    turned = np.array([[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]], dtype=float)
    scene = trimesh.Scene()
    scene.add_geometry(part, node_name="here")
    scene.add_geometry(part, node_name="there", transform=turned)
    scene.export(tmp_path / "scene.glb")
    shape = symsurf.read(tmp_path / "scene.glb")
    there = POINTS @ turned[:3, :3].T + turned[:3, 3]
    expected = np.concatenate([POINTS[FACES], there[FACES]]).reshape(-1, 9)
    found = shape.points[shape.faces].reshape(-1, 9)
    assert sorted(map(tuple, found)) == sorted(map(tuple, expected))


@pytest.mark.parametrize("encoding", list(pypcd4.Encoding))
def test_pcd_in_each_encoding_with_normals(encoding, tmp_path):
    normals = np.tile((0.0, 0.6, 0.8), (40, 1))
    fields = ("x", "y", "z", "normal_x", "normal_y", "normal_z")
    cloud = pypcd4.PointCloud.from_points(
        np.hstack([POINTS, normals]), fields, (np.float64,) * len(fields)
    )
    cloud.save(tmp_path / "cloud.pcd", encoding=encoding)
    shape = symsurf.read(tmp_path / "cloud.pcd")
    np.testing.assert_allclose(shape.points, POINTS, atol=1e-9)
    np.testing.assert_allclose(shape.normals, normals, atol=1e-9)


def test_a_cell_that_names_a_point_which_is_not_there(tmp_path):
    path = tmp_path / "wrong.vtk"
    path.write_text(
        "# vtk DataFile Version 3.0\nwrong\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n"
        "0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 99999999\n"
    )
    with pytest.raises(symsurf.InvalidInput, match="a cell names point 99999999; there are 3"):
        symsurf.read(path)


def test_a_vtp_of_symsurf_is_read(tmp_path):
    points, _ = mirrored_surface(400, 1)
    np.savetxt(tmp_path / "cloud.xyz", points, fmt="%.17g")
    done = run_here("align cloud.xyz --method plane --format vtp --output made", tmp_path)
    assert done.returncode == 0, done.stderr
    aligned = symsurf.align(points, symsurf.detect(points, "plane")).shape.points
    np.testing.assert_array_equal(symsurf.read(tmp_path / "made/cloud.vtp").points, aligned)
    result = symsurf.detect(points, "plane")
    result.save(tmp_path / "result.vtp")
    shape = symsurf.read(tmp_path / "result.vtp")
    vertices, triangles = result.mirror.mesh(points)
    np.testing.assert_array_equal(shape.points, np.vstack([result.surface_points, vertices]))
    np.testing.assert_array_equal(shape.points[shape.faces], vertices[triangles])


def test_a_mesh_of_vtk_is_operated_on_and_written(tmp_path):
    sphere = pyvista.Sphere(radius=2, theta_resolution=12, phi_resolution=12)
    sphere.save(tmp_path / "mesh.vtp")
    for words, suffix in (("", ".ply"), ("--format vtp", ".vtp")):
        line = f"symmetrize mesh.vtp --method plane {words} --output made"
        done = run_here(line, tmp_path)
        assert done.returncode == 0, done.stderr
        made = symsurf.read(tmp_path / f"made/mesh{suffix}")
        assert len(made.points) == sphere.n_points and len(made.faces) == sphere.n_cells


# Masks and images.


def test_the_mirror_of_a_mask_is_in_world_coordinates(tmp_path):
    voxels = np.zeros((21, 24, 18), np.uint8)
    voxels[3:18, 2:20, 4:9] = 1
    voxels[8:13, 5:9, 9:16] = 1  # even about i = 10 alone
    affine = np.array([[-1.5, 0, 0, 40], [0, 2, 0, -7], [0, 0, 1, 3], [0, 0, 0, 1]])
    nibabel.Nifti1Image(voxels, affine).to_filename(tmp_path / "mask.nii.gz")
    result = symsurf.detect(tmp_path / "mask.nii.gz", "plane")
    truth = symsurf.Plane((1, 0, 0), -(40 - 1.5 * 10))
    angle, gap = difference(result.mirror, truth, chosen(voxels, affine))
    assert result.verdict == "found" and angle < 0.01 and gap < 1e-4


@pytest.mark.parametrize("suffix", [".nii", ".nrrd", ".vti"])
def test_images_need_a_threshold(suffix, tmp_path):
    values = np.random.default_rng(0).normal(size=(5, 6, 7)).astype(np.float32)
    path = tmp_path / f"image{suffix}"
    if suffix == ".nii":
        nibabel.Nifti1Image(values, np.eye(4)).to_filename(path)
    elif suffix == ".nrrd":
        nrrd.write(str(path), values)
    else:
        image = pyvista.ImageData(dimensions=values.shape)
        image["value"] = values.ravel("F")
        image.save(path)
    points = symsurf.read(path, threshold=0.5).points
    np.testing.assert_array_equal(by_position(points), by_position(np.argwhere(values > 0.5) * 1.0))
    with pytest.raises(symsurf.InvalidInput, match="give threshold=NUMBER"):
        symsurf.read(path)
    with pytest.raises(symsurf.InvalidInput, match="above threshold=99"):
        symsurf.read(path, threshold=99)
    with pytest.raises(symsurf.InvalidParameter, match="threshold is 'high'"):
        symsurf.read(path, threshold="high")
    done = run("detect", path, "--threshold", "0.5", "--method", "plane", "--json")
    assert json.loads(done.stdout)["points"] == len(points)


def test_masks_of_other_types_and_axes(tmp_path):
    nibabel.Nifti1Image(mask()[..., None].astype(np.float64), AFFINE).to_filename(
        tmp_path / "real.nii"
    )
    np.testing.assert_allclose(symsurf.read(tmp_path / "real.nii").points, chosen(mask()))
    nrrd.write(str(tmp_path / "even.nrrd"), mask(), {"spacings": [2, 3, 4]})
    np.testing.assert_array_equal(
        by_position(symsurf.read(tmp_path / "even.nrrd").points),
        by_position(np.argwhere(mask()) * (2.0, 3, 4)),
    )
    nrrd.write(str(tmp_path / "colours.nrrd"), np.stack([mask(), mask()]))
    with pytest.raises(symsurf.InvalidInput, match=r"colours.nrrd: the image has 4 axes"):
        symsurf.read(tmp_path / "colours.nrrd")


def test_a_threshold_for_what_is_no_image(tmp_path):
    write_poly_data(tmp_path / "mesh.vtk")
    (tmp_path / "cloud.xyz").write_text("0 0 0\n1 0 0\n")
    for name in ("mesh.vtk", "cloud.xyz"):
        with pytest.raises(symsurf.InvalidParameter, match="threshold is 1; allowed is None"):
            symsurf.read(tmp_path / name, threshold=1)


@pytest.mark.parametrize("encoding", ["gzip", "bzip2", "raw", "ascii"])
@pytest.mark.parametrize("name", ["mask.nrrd", "mask.nhdr"])
def test_nrrd_in_each_encoding(encoding, name, tmp_path):
    header = {"encoding": encoding, "space directions": AFFINE[:3, :3].T}
    nrrd.write(str(tmp_path / name), 300 * mask().astype(">i2"), header | {"space": "LPS"})
    content = (tmp_path / name).read_bytes()
    (tmp_path / name).rename(tmp_path / "mask.nrrd")
    expected = chosen(mask()) - AFFINE[:3, 3]
    points = symsurf.read(tmp_path / "mask.nrrd").points
    np.testing.assert_allclose(by_position(points), by_position(expected))
    if encoding in ("gzip", "bzip2") and name == "mask.nrrd":
        head, _, packed = content.partition(b"\n\n")
        (tmp_path / "lines.nrrd").write_bytes(head + b"\nline skip: 2\n\na\nb\n" + packed)
        np.testing.assert_array_equal(symsurf.read(tmp_path / "lines.nrrd").points, points)
