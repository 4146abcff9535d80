"""How the zips of the module are made of whatever wheels there are; needs no 3D Slicer."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_a_zip_for_each_system_that_slicer_has(tmp_path):
    version = (ROOT / "CMakeLists.txt").read_text().split("symsurf VERSION ")[1].split()[0]
    names = [
        f"symsurf-{version}-cp312-cp312-manylinux_2_17_x86_64.manylinux2014_x86_64.whl",
        f"symsurf-{version}-cp312-cp312-win_amd64.whl",
        f"symsurf-{version}-cp311-cp311-win_amd64.whl",
    ]
    for name in names:
        (tmp_path / name).touch()
    command = [
        sys.executable,
        ROOT / "packaging" / "hosts.py",
        "--slicer",
        tmp_path,
        tmp_path / "made",
    ]
    subprocess.run(command, check=True)
    found = {path.name: zipfile.ZipFile(path).namelist() for path in (tmp_path / "made").iterdir()}
    assert set(found) == {
        f"symsurf-{version}-slicer-manylinux2014_x86_64.zip",
        f"symsurf-{version}-slicer-win_amd64.zip",
    }
    for (_, files), wheel in zip(sorted(found.items()), names, strict=False):
        assert f"MirrorSymmetry/Resources/wheels/{wheel}" in files
        assert {"MirrorSymmetry/MirrorSymmetry.py", "LICENSE"} <= {*files}
