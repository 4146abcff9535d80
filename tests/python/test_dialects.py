"""The same shape in every dialect of a format is read as the same shape."""

from __future__ import annotations

import re

import numpy as np
import pytest
from dialects import FACES, POINTS, clouds, data_sets, images, scenes, texts

import symsurf

FORMATS = {
    ".ply": texts.PLY,
    ".obj": texts.OBJ,
    ".off": texts.OFF,
    ".stl": texts.STL,
    ".csv": texts.TABLE,
    ".gltf": scenes.GLTF,
    ".3mf": scenes.THREE_MF,
    ".vtk": data_sets.VTK,
    ".las": clouds.LAS,
    ".pcd": clouds.PCD,
    ".nrrd": images.NRRD,
    ".nii": images.NIFTI,
}
CASES = [(suffix, name) for suffix, dialects in FORMATS.items() for name in dialects]
REFUSED = {  # by their names
    ".obj": {
        "v 1 2 3\nv 0 0 1\n".encode(encoding): "UTF-16"
        for encoding in ("utf-16", "utf-16-le", "utf-16-be")
    }
    | {
        f"v 0 1 2\nv {number} 0 0\n".encode(): f"line 2: a coordinate is '{re.escape(number)}'"
        for number in ("3.1+e2", "3.1+2", "3.1d2", "3,1", "0x10", "1e", "--1")
    },
    ".off": {
        f"{keyword}\n".encode() + bytes(60): "binary OFF"
        for keyword in (
            "OFF BINARY",
            "COFF BINARY",
            "NOFF  BINARY",
            "off binary",
            "OFF\nBINARY",
            "# a\nSTOFF BINARY",
        )
    }
    | {b"4OFF\n1 0 0\n0 0 0 1\n": "4OFF"},
    ".csv": {
        b"1,5,5,5\n2,6,6,6\n3,7,7,9\n": "counts the rows",
        "x,y,z\n1,2,3\n".encode("utf-16"): "UTF-16",
        b"7\n1 2 3\n": "no number of rows",
    },
    ".stl": {b"version https://git-lfs.github.com/spec/v1\noid sha256:4d\n": "pointer of Git LFS"},
    ".ply": {b"\n <!DOCTYPE html><html>not found</html>": "HTML page", b"\x1f\x8b\x08": "gzip"},
    ".gltf": scenes.REFUSED_GLTF,
    ".3mf": scenes.REFUSED_THREE_MF,
    ".las": clouds.REFUSED_LAS,
    ".pcd": clouds.REFUSED_PCD,
    ".vtk": data_sets.REFUSED_VTK,
    ".nrrd": images.REFUSED_NRRD,
    ".nii": images.REFUSED_NIFTI,
}


def corners(points, faces):
    """The triangles by their corners, the first of which is the least, in order."""
    rows = [tuple(map(tuple, face)) for face in points[faces].tolist()]
    return sorted(min(row[i:] + row[:i] for i in range(3)) for row in rows)


def test_enough_of_each():
    assert len(FORMATS) == 12 and all(len(dialects) >= 20 for dialects in FORMATS.values())


@pytest.mark.parametrize(("suffix", "name"), CASES)
def test_a_dialect(suffix, name, tmp_path):
    content = FORMATS[suffix][name]
    path = tmp_path / f"shape{suffix}"
    if isinstance(content, tuple):  # with a suffix of its own, or written by a library
        path = path.with_suffix(content[0])
        content = content[1]
    if callable(content):
        content(path)
    else:
        path.write_bytes(content)
    shape = symsurf.read(path)
    if suffix in (".nrrd", ".nii"):
        expected = images.CHOSEN
    elif suffix in (".csv", ".las", ".pcd") or name in ("points", "vertices"):
        expected = POINTS
    else:
        assert corners(shape.points, shape.faces) == corners(POINTS, FACES)
        return
    assert shape.faces is None
    np.testing.assert_allclose(ordered(shape.points), ordered(expected), atol=1e-9)


def ordered(points):
    return points[np.lexsort(points.round(6).T)]


@pytest.mark.parametrize(
    ("suffix", "content"), [(suffix, content) for suffix in REFUSED for content in REFUSED[suffix]]
)
def test_what_is_refused_is_named(suffix, content, tmp_path):
    path = tmp_path / f"shape{suffix}"
    path.write_bytes(content)
    with pytest.raises(symsurf.InvalidInput, match=REFUSED[suffix][content]) as error:
        symsurf.read(path)
    assert str(error.value).startswith(f"{path}: ")


@pytest.mark.parametrize("suffix", FORMATS)
def test_damage_is_an_error_of_the_file(suffix, tmp_path, capfd):
    """Cut, and with bytes changed: a shape or an error that names the file, and nothing else."""
    random = np.random.default_rng(0)
    contents = [each for each in FORMATS[suffix].values() if isinstance(each, bytes)]
    path = tmp_path / f"shape{suffix}"
    for content in contents:
        cut = content[: random.integers(1, len(content))]
        changed = bytearray(content)
        for at in random.integers(0, len(content), 3):
            changed[at] = random.integers(0, 256)
        for damaged in (cut, bytes(changed)):
            path.write_bytes(damaged)
            try:
                assert len(symsurf.read(path).points)
            except symsurf.InvalidInput as error:
                assert str(error).startswith(f"{path}: ") and "\n" not in str(error)
    assert capfd.readouterr().err == ""
