"""The tables of bad input, in Python and on the command line."""

from __future__ import annotations

import json
import os

import numpy as np
import pytest
from bad_input import tables
from command_line import run, run_here

import symsurf

GOOD = np.random.default_rng(0).normal(size=(50, 3))


def named(rows):
    return [pytest.param(row, id=f"{i} {row.name}") for i, row in enumerate(rows)]


def array(points):
    return np.array(points, float).reshape(-1, 3)


def assert_python_lives():
    assert 0 <= symsurf.detect_plane(GOOD).score <= 1


@pytest.mark.parametrize("cloud", named(tables.clouds()))
def test_clouds_in_python(cloud):
    nonfinite = "refuse" if cloud.refuses_nonfinite else "skip"
    for method in symsurf.methods():
        with pytest.raises(symsurf.InvalidInput) as error:
            symsurf.detect(array(cloud.points), method, nonfinite=nonfinite)
        assert cloud.reason in str(error.value)
    assert_python_lives()


@pytest.mark.parametrize("cloud", named(tables.clouds()))
def test_clouds_of_analyses(cloud):
    nonfinite = "refuse" if cloud.refuses_nonfinite else "skip"
    for name, analysis in symsurf.analyses().items():
        shapes = [array(cloud.points)] * (1 + analysis.takes_other)
        with pytest.raises(symsurf.InvalidInput) as error:
            getattr(symsurf, name)(*shapes, nonfinite=nonfinite)
        assert cloud.reason in str(error.value)
    assert_python_lives()


@pytest.mark.parametrize("mirror", named(tables.mirrors()))
def test_mirrors_in_python(mirror):
    numbers = {
        name: value if isinstance(value, (float, str)) else np.array(value)
        for name, value in mirror.numbers.items()
    }
    with pytest.raises((symsurf.InvalidInput, symsurf.InvalidParameter)) as error:
        symsurf._core.make_mirror(mirror.kind, numbers)
    assert mirror.reason in str(error.value)


@pytest.mark.parametrize("file", named(tables.files()))
def test_files_in_python_and_on_the_command_line(file, tmp_path):
    path = tmp_path / file.name
    path.write_bytes(file.content)
    for read in (symsurf.read, symsurf.detect):
        with pytest.raises(symsurf.InvalidInput) as error:
            read(path)
        assert str(error.value).startswith(f"{path}: {file.reason}")
    assert_refused_and_the_rest_done(path, file.reason)


@pytest.mark.parametrize("cloud", named(tables.clouds()[1:]))  # a file of no points is in files.tsv
def test_clouds_on_the_command_line(cloud, tmp_path):
    path = tmp_path / "bad.csv"
    rows = "\n".join(",".join(map(repr, point)) for point in cloud.points)
    path.write_text(f"x,y,z\n{rows}\n")
    assert_refused_and_the_rest_done(path, cloud.reason, refuse=cloud.refuses_nonfinite)


@pytest.mark.parametrize("option", ["", "--downsample 2"])
def test_no_point_is_finite(option, tmp_path):
    path = tmp_path / "bad.xyz"
    path.write_text(9 * "nan 0 0\n")
    assert_refused_and_the_rest_done(path, "0 of 9 points", option=option)


def assert_refused_and_the_rest_done(path, reason, refuse=False, option=""):
    """One line says why, and the file after it is done."""
    good = path.with_name("good.xyz")
    np.savetxt(good, GOOD)
    output = path.with_name("results")
    words = f"--nonfinite refuse {option}" if refuse else option
    done = run_here(
        f"detect {path.name} good.xyz --method plane --json --output {output} {words}", path.parent
    )
    assert done.returncode == 1
    errors = done.stderr.splitlines()
    assert len(errors) == 1 and path.name in errors[0] and reason in errors[0]
    assert json.loads(done.stdout)["file"] == "good.xyz"
    assert {file.name for file in output.iterdir()} == {"good.summary.json"}


def nothing(path):
    """No file of that name."""


NAMES = {
    "none": ("none.ply", nothing, "there is no such file"),
    "folder": ("folder.ply", lambda path: path.mkdir(), "this is not a file"),
    "pipe": ("pipe.ply", os.mkfifo, "this is not a file"),
    "link to nothing": (
        "link.ply",
        lambda path: path.symlink_to("nowhere"),
        "there is no such file",
    ),
    "link to itself": ("link.ply", lambda path: path.symlink_to(path), "there is no such file"),
    "folder of a file": ("good.xyz/a.ply", nothing, "there is no such file"),
    "too long": (300 * "a" + ".ply", nothing, "there is no such file"),
    "no suffix": ("a", nothing, "suffix '' is none of .ply"),
    "suffix alone": (".ply", nothing, "suffix '' is none of .ply"),
    "two lines": ("a\nb.ply", nothing, "there is no such file"),
    "not UTF-8": (os.fsdecode(b"\xff.ply"), nothing, "there is no such file"),
    "umlaut": ("ä.ply", nothing, "there is no such file"),
    "format": ("%s%n{0}.ply", nothing, "there is no such file"),
    "holes": ("holes.ply", lambda path: os.truncate(made(path), 8 * 10**12), "the file has 8000"),
}


def made(path):
    path.touch()
    return path


@pytest.mark.parametrize("name", NAMES)
def test_names(name, tmp_path):
    file, make, reason = NAMES[name]
    path = tmp_path / file
    np.savetxt(tmp_path / "good.xyz", GOOD)
    make(path)
    for read in (symsurf.read, symsurf.detect):
        with pytest.raises(symsurf.InvalidInput) as error:
            read(path)
        assert str(error.value).startswith(f"{path}: {reason}")
    done = run("detect", file, "good.xyz", "--json", cwd=tmp_path)
    assert done.returncode == 1 and json.loads(done.stdout)["file"] == "good.xyz"
    assert len(done.stderr.splitlines()) == 1 and reason in done.stderr


@pytest.mark.parametrize("path", [None, 5, 1.5, [], object(), "a\0.ply"])
def test_what_names_no_file(path):
    with pytest.raises(symsurf.InvalidInput, match="path is .*; allowed is the name of a file"):
        symsurf.read(path)


def test_a_good_file_of_any_name(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "utf-8:strict")  # Python's choice in most locales
    name = os.fsdecode(b"\xff.xyz")
    np.savetxt(tmp_path / name, GOOD)
    for words in ((), ("--json",)):
        done = run("detect", name, *words, cwd=tmp_path, errors="surrogateescape")
        assert done.returncode == 0 and done.stderr == ""
    assert json.loads(done.stdout)["file"] == name


def out_of_range():
    for method in symsurf.methods().values():
        for parameter, value in tables.numbers_out_of_range(method.parameters):
            name = f"{method.name}-{parameter.name}-{value}"
            yield pytest.param(method.name, parameter, value, id=name)


@pytest.mark.parametrize(("method", "parameter", "value"), list(out_of_range()))
def test_numbers_out_of_range_on_the_command_line(method, parameter, value, tmp_path):
    np.savetxt(tmp_path / "good.xyz", GOOD)
    option = f"--{parameter.name.replace('_', '-')}={value}"
    done = run_here(f"detect good.xyz --method {method} {option} --json", tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert f"{parameter.name} is " in done.stderr and parameter.range in done.stderr
    assert len(done.stderr.splitlines()) == 1
