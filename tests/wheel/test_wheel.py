"""The wheel in an environment that has nothing but it and what it requires: no compiler, no library
of the system beyond those that every Linux has. Nothing is downloaded. The wheel of `make wheel`, and
those for Linux on x86-64 of `make wheels`."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tarfile
import time
import zipfile
from itertools import chain
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
NEEDS = ROOT / "build/wheel/needs"
MADE = ROOT / "build/wheels"  # of make wheels
LARGEST = 15e6  # bytes
LONGEST = 60  # seconds, from nothing to the first mirror

# Those of the C library and of the compiler, which manylinux takes for granted.
GRANTED = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|util|pthread|gcc_s|stdc\+\+))\.so\.\d+")

BALL = """
import numpy, symsurf
points = numpy.random.default_rng(0).normal(size=(500, 3)) * (1, 2, 3) + (4, 0, 0)
points = numpy.concatenate([points, points * (-1, 1, 1)])
"""


def built(pattern: str) -> Path:
    files = list((ROOT / "build/dist").glob(pattern))
    if not files:
        pytest.skip(f"no {pattern} in build/dist: run make wheel")
    (file,) = files
    return file


def wheels() -> list[object]:
    """That of this Python, and those of others."""
    others = sorted((MADE / "dist").glob("*manylinux*_x86_64.whl"))
    return [
        pytest.param(None, id="make wheel"),
        *(pytest.param(each, id=each.name.split("-")[2]) for each in others),
    ]


@pytest.fixture(scope="module", params=wheels())
def wheel(request) -> Path:
    return request.param or built("*.whl")


def interpreter(wheel: Path) -> str:
    """One of the wheel's version, of this machine or of those that its headers came with."""
    if MADE not in wheel.parents:
        return sys.executable
    version = re.sub(r"cp3(\d+)", r"3.\1", wheel.name.split("-")[2])
    installed = (Path.home() / ".pyenv/versions").glob(f"{version}.*/bin/python")
    brought = (MADE / "pythons/linux-x86_64").glob(f"{version}/bin/python{version}")
    return str(next(chain(installed, brought)))


def environment(folder: Path, wheel: Path) -> Path:
    """The Python of one without pip, with the wheel and what it needs."""
    subprocess.run([interpreter(wheel), "-m", "venv", "--without-pip", folder], check=True)
    python = folder / "bin/python"
    install = [sys.executable, "-m", "pip", "--python", python, "install", "--no-index"]
    needs = ["--find-links", NEEDS, "--find-links", MADE / "needs"]
    subprocess.run([*install, *needs, wheel], check=True, capture_output=True)
    return python


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory) -> Path:
    return environment(tmp_path_factory.mktemp("environment"), wheel)


def run(program: Path, *words: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    """A program of the environment, which finds no others."""
    environment = {"PATH": str(program.parent), "HOME": str(cwd), "LANG": "C.UTF-8"}
    return subprocess.run(
        [str(word) for word in (program, *words)],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


@pytest.fixture
def scan(python, tmp_path) -> Path:
    done = run(python, "-c", f"{BALL}numpy.savetxt('scan.xyz', points)", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    return tmp_path / "scan.xyz"


def test_size_and_name(wheel):
    assert wheel.stat().st_size <= LARGEST
    assert "manylinux" in wheel.name


def test_first_mirror_from_nothing(wheel, tmp_path):
    """An environment, the wheel and NumPy in it, a mirror; a mesh too, which needs OpenMesh."""
    started = time.perf_counter()
    python = environment(tmp_path, wheel)
    done = run(python, ROOT / "tests/wheel/first_mirror.py", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert time.perf_counter() - started < LONGEST


def test_mirror_is_found(python, tmp_path):
    code = f"{BALL}result = symsurf.detect(points)\nprint(result.verdict, *result.mirror.normal)"
    done = run(python, "-c", code, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    verdict, x, y, z = done.stdout.split()
    assert verdict == "found"
    assert (float(x), float(y), float(z)) == pytest.approx((1, 0, 0), abs=1e-9)


def test_meshes_work(python, tmp_path):
    """They need OpenMesh, which is in the wheel."""
    (tmp_path / "box.off").write_bytes((ROOT / "tests/package/box.off").read_bytes())
    done = run(python, "-m", "symsurf", "asymmetry", "box.off", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "found" in done.stdout


def test_libraries_are_those_of_the_environment(wheel, python, tmp_path):
    if MADE in wheel.parents:
        pytest.skip("all are within the module")
    code = "import symsurf\nfor line in open('/proc/self/maps'): print(line.split()[-1])"
    mapped = set(run(python, "-c", code, cwd=tmp_path).stdout.split())
    site = python.parents[1] / "lib"
    for name in ("symsurf/_core.", "libOpenMeshCore"):
        found = [Path(path) for path in mapped if name in path]
        assert found and all(path.is_relative_to(site) for path in found), found


def test_libraries_are_stripped_and_need_what_every_linux_has(wheel, tmp_path):
    zipfile.ZipFile(wheel).extractall(tmp_path)
    inside = {path.name: path for path in tmp_path.rglob("*.so*")}
    for name, path in inside.items():
        command = ["readelf", "--wide", "--dynamic", "--sections", path]
        said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        assert ".symtab" not in said, name
        needed = re.findall(r"\(NEEDED\).*\[(.*)\]", said)
        assert needed, name
        missing = [each for each in needed if each not in inside and not GRANTED.fullmatch(each)]
        assert not missing, f"{name} needs {missing}"


def test_types_and_licences_come_along(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    assert {"symsurf/py.typed", "symsurf/_core.pyi"} <= set(names)
    for licence in (
        "LICENSE",
        "licenses/OpenMesh.txt",
        "licenses/nanoflann.txt",
        "licenses/Spectra.txt",
        "licenses/pybind11.txt",
    ):
        assert any(name.endswith(f".dist-info/licenses/{licence}") for name in names)


def test_command_runs(python, scan):
    for command in ([python.parent / "symsurf"], [python, "-m", "symsurf"]):
        done = run(*command, "detect", scan.name, cwd=scan.parent)
        assert done.returncode == 0, done.stderr
        assert "found" in done.stdout


@pytest.mark.parametrize(
    ("line", "extra"),
    [
        ("demo", "report"),
        ("demo --no-pictures", "plot"),
        ("demo thesis", "plot"),
        ("report scan.xyz --output report.html", "report"),
        ("detect scan.xyz --plot --output pictures", "plot"),
        ("asymmetry scan.xyz --plot --output pictures --jobs 2", "plot"),
    ],
)
def test_commands_name_the_extra_that_is_missing(python, scan, line, extra):
    done = run(python, "-m", "symsurf", *line.split(), cwd=scan.parent)
    assert done.returncode == 2
    assert re.fullmatch(rf"symsurf: .* pip install 'symsurf\[{extra}\]'\n", done.stderr)
    assert os.listdir(scan.parent) == [scan.name]


@pytest.mark.parametrize(
    ("statement", "extra"),
    [
        ("import symsurf.vtk", "vtk"),
        ("symsurf.detect(points).plot('picture.png')", "plot"),
        ("symsurf.asymmetry(points).plot('picture.png')", "plot"),
        ("symsurf.Shape(points).to_pyvista()", "plot"),
    ],
)
def test_python_names_the_extra_that_is_missing(python, tmp_path, statement, extra):
    done = run(python, "-c", f"{BALL}\n{statement}", cwd=tmp_path)
    if "libffi" in done.stderr:
        pytest.skip("this Python cannot load ctypes, by which drawing looks for libraries")
    assert re.search(rf"Error: .* pip install 'symsurf\[{extra}\]'$", done.stderr.strip())


def test_extras_are_those_that_the_package_names(wheel):
    archive = zipfile.ZipFile(wheel)
    (metadata,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
    text = archive.read(metadata).decode()
    assert set(re.findall(r"^Provides-Extra: (.*)$", text, re.MULTILINE)) >= {
        "plot",
        "report",
        "vtk",
    }


def test_source_distribution_is_complete():
    """All that git has, but for git's own."""
    archive = built("*.tar.gz")
    with tarfile.open(archive) as file:
        names = {name.partition("/")[2] for name in file.getnames()}
    listed = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode != 0:
        pytest.skip("not a clone")
    missing = {name for name in listed.stdout.split("\n") if name} - names
    assert {name for name in missing if (ROOT / name).exists()} == set()
