"""The README's examples in Python and those of every page run."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from symmetric_shapes import mirrored_surface

import symsurf

README = (ROOT / "README.md").read_text()
START = (ROOT / "docs/start.md").read_text()


# Examples in Python that import these run inside another program.
HOSTS = r"^(?:import|from) (?:bpy|paraview|pymeshlab|slicer)\b"


def examples(language: str, page: str = README) -> list[str]:
    found = re.findall(rf"^```{language}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    return [example for example in found if not re.search(HOSTS, example, re.MULTILINE)]


@pytest.fixture
def folder(tmp_path):
    """Where the examples find the files they name."""
    points, _ = mirrored_surface(600, 0)
    rows = "\n".join(" ".join(map(repr, point)) for point in points.tolist())
    header = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
    properties = "".join(f"property double {axis}\n" for axis in "xyz")
    for name in ("scan.ply", "other.ply", "part.ply"):
        (tmp_path / name).write_text(f"{header}{properties}end_header\n{rows}\n")
    x, y = (each.ravel() for each in np.meshgrid(np.linspace(-1, 1, 21), np.linspace(0, 3, 31)))
    corners = (np.arange(30)[:, None] * 21 + np.arange(20)).reshape(-1, 1)
    faces = np.vstack([corners + (0, 1, 22), corners + (0, 22, 21)])
    mesh = symsurf.Shape(np.column_stack([x, y, x**2 + 0.3 * y**2 + 0.1 * y**3]), faces)
    symsurf.correspondences(mesh, symsurf.Plane((1, 0, 0), 0)).save(tmp_path / "mesh.ply")
    return tmp_path


def output_of(example: str, folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", f"import symsurf\n{example}"],
        cwd=folder,
        env=os.environ | {"PYVISTA_OFF_SCREEN": "true"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("example", examples("python", README))
def test_python_examples(example, folder):
    pytest.importorskip("pyvista")
    output_of(example, folder)


PAGES = [ROOT / "docs/methods" / f"{name}.md" for name in symsurf.methods()]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_examples_of_the_methods_pages_find_the_mirror(page, tmp_path):
    (example,) = examples("python", page.read_text())
    assert "found" in output_of(example, tmp_path)


OPERATIONS = symsurf.operations()
# Of each page its description, and the folder that it and its picture are in.
DESCRIBED = {
    **{name: (each, "operations") for name, each in OPERATIONS.items()},
    **{name: (each, "symmetries") for name, each in symsurf.analyses().items()},
}


def page_of(name: str) -> Path:
    return ROOT / "docs" / DESCRIBED[name][1] / f"{name}.md"


@pytest.mark.parametrize("name", DESCRIBED)
def test_examples_of_the_pages_print_what_they_say(name, tmp_path):
    example = "\n".join(examples("python", page_of(name).read_text()))
    said = re.findall(r"^print\(.*\)  # (.*)$", example, re.MULTILINE)
    assert said and output_of(example, tmp_path).splitlines() == said


@pytest.mark.parametrize("name", DESCRIBED)
def test_pages_have_pictures_and_parameters(name):
    described, folder = DESCRIBED[name]
    page = page_of(name).read_text()
    for picture in re.findall(r"\]\((\S+\.png)\)", page):
        assert (page_of(name).parent / picture).is_file()
    assert f"../images/{folder}/{name}.png" in page
    for parameter in described.parameters:
        assert f"`{parameter.name}`" in page.split("**Parameters**")[1]


def script_of(page: Path) -> str:
    """The examples of a page in one script, as later ones may use what earlier ones made."""
    return "\n".join(examples("python", page.read_text()))


TESTED_ONE_BY_ONE = {*PAGES, *map(page_of, DESCRIBED), ROOT / "docs/command_line.md"}
OTHER_PAGES = [
    page
    for page in sorted(ROOT.glob("docs/**/*.md"))
    if page not in TESTED_ONE_BY_ONE and script_of(page)
]


@pytest.mark.parametrize("page", OTHER_PAGES, ids=lambda page: page.stem)
def test_examples_of_the_other_pages(page, folder):
    pytest.importorskip("pyvista")
    if "dask" in script_of(page):
        pytest.importorskip("distributed")
    output_of(script_of(page), folder)


def command_lines() -> list[str]:
    lines = "".join(examples("console", README) + examples("console", START)).splitlines()
    commands = (line[2:].split("#")[0].strip() for line in lines if line.startswith("$ symsurf "))
    return list(dict.fromkeys(commands))


@pytest.mark.parametrize("line", command_lines())
def test_command_line_examples(line, folder):
    pytest.importorskip("pyvista")
    command = [sys.executable, "-m", "symsurf", *line.split()[1:]]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


COMMAND_LINE = (ROOT / "docs/command_line.md").read_text()


@pytest.mark.parametrize("example", examples("python", COMMAND_LINE))
def test_examples_of_batches(example, folder):
    if "dask" in example:
        pytest.importorskip("distributed")
    output_of(example, folder)


@pytest.mark.parametrize("line", examples("console", COMMAND_LINE)[0].splitlines())
def test_examples_of_many_files(line, folder):
    pytest.importorskip("trame_vtk")
    command = [sys.executable, "-m", "symsurf", *line.removeprefix("$ symsurf ").split()]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_there_are_examples():
    assert examples("python", README) and command_lines()
