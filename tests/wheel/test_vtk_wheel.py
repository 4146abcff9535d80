"""symsurf-vtk in an environment that has nothing but it and what it requires: no compiler, no VTK of
the system. Nothing is downloaded."""

from __future__ import annotations

import re
import subprocess
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build/vtk-wheel"
BUILDER = ROOT / "build/vtk-python/bin/python"  # of 3.12 or later
LARGEST = 15e6  # bytes


@pytest.fixture(scope="module")
def wheel() -> Path:
    files = list((BUILD / "dist").glob("symsurf_vtk-*.whl"))
    if not files:
        pytest.skip("no wheel in build/vtk-wheel/dist: make vtk-wheel builds it, with Python 3.12")
    (file,) = files
    return file


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory) -> Path:
    """The Python of an environment without pip, with the wheel."""
    made = tmp_path_factory.mktemp("environment")
    subprocess.run([BUILDER, "-m", "venv", "--without-pip", made], check=True)
    install = [BUILDER, "-m", "pip", "--python", made / "bin/python", "install", "--no-index"]
    subprocess.run(
        [*install, "--find-links", BUILD / "needs", wheel], check=True, capture_output=True
    )
    return made / "bin/python"


def run(python: Path, *words: object) -> subprocess.CompletedProcess[str]:
    environment = {"PATH": str(python.parent), "LANG": "C.UTF-8"}
    command = [str(word) for word in (python, *words)]
    return subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=300, check=False
    )


def test_filters_work(python):
    """The test of the wrapping for every VTK: each class, and what errors say."""
    done = run(python, ROOT / "tests/vtk/wrapping.py")
    assert done.returncode == 0, done.stderr
    assert re.search(r"^Ran \d+ tests", done.stderr, re.MULTILINE)


def test_the_example_of_its_description_runs(python):
    text = (ROOT / "vtk_filters/wheel/README.md").read_text()
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    done = run(python, "-c", code)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == pytest.approx(0, abs=1e-6)  # cvista's cube is of single precision


def test_one_file_serves_every_python(wheel):
    assert re.search(r"-cp312-abi3-manylinux_\w+\.whl$", wheel.name)
    assert wheel.stat().st_size <= LARGEST
    names = zipfile.ZipFile(wheel).namelist()
    assert "symsurf_filters/vtkSymsurfFilters.abi3.so" in names
    for licence in ("LICENSE", "licenses/OpenMesh.txt", "licenses/nanoflann.txt"):
        assert any(name.endswith(f".dist-info/licenses/{licence}") for name in names)
    left_out = {"include", "lib", "lib64", "cmake"} & {name.split("/")[0] for name in names}
    assert not left_out


def test_metadata_says_what_it_needs(wheel):
    archive = zipfile.ZipFile(wheel)
    (metadata,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
    text = archive.read(metadata).decode()
    assert re.search(r"^Requires-Dist: cvista==9\.7\.\*$", text, re.MULTILINE)
    assert "Requires-Python: >=3.12" in text
    version = re.search(r"symsurf VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert f"\nVersion: {version[1]}\n" in text


def test_libraries_need_cvistas_and_what_every_linux_has(wheel, tmp_path):
    zipfile.ZipFile(wheel).extractall(tmp_path)
    inside = {path.name: path for path in tmp_path.rglob("*.so*")}
    granted = r"libvtk.*-cvista\.so|(ld-linux.*|lib(c|m|dl|pthread|gcc_s|stdc\+\+))\.so\.\d+"
    assert len(inside) >= 2
    for name, path in inside.items():
        said = subprocess.run(
            ["readelf", "--wide", "--dynamic", "--sections", path],
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        assert ".symtab" not in said, name
        needed = re.findall(r"\(NEEDED\).*\[(.*)\]", said)
        missing = [
            each for each in needed if each not in inside and not re.fullmatch(granted, each)
        ]
        assert not missing, f"{name} needs {missing}"
        assert str(ROOT) not in said, name  # no path of the build
