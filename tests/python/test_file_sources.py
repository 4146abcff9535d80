"""Where files come from: packed and open files, standard input, folders; and names that a terminal
cannot encode."""

from __future__ import annotations

import gzip
import io
import json
import os
import subprocess
import sys

import numpy as np
import pytest
from command_line import run
from symmetric_shapes import mirrored_surface

import symsurf


@pytest.fixture
def cloud(tmp_path):
    points, _ = mirrored_surface(300, 2)
    np.savetxt(tmp_path / "cloud.xyz", points, fmt="%.17g")
    return points


def test_packed_files(cloud, tmp_path):
    packed = gzip.compress((tmp_path / "cloud.xyz").read_bytes())
    (tmp_path / "packed.xyz.gz").write_bytes(packed)
    np.testing.assert_array_equal(symsurf.read(tmp_path / "packed.xyz.gz").points, cloud)
    for name, content in {
        "short.xyz.gz": packed[:-20],
        "plain.xyz.gz": b"0 0 0\n",
        "empty.xyz.gz": gzip.compress(b""),
        "word.xyz.gz": gzip.compress(b"0 0 zero\n"),
        "what.gz": packed,
    }.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(symsurf.InvalidInput) as error:
            symsurf.read(tmp_path / name)
        assert str(error.value).startswith(f"{tmp_path / name}: ") and "/symsurf-" not in str(
            error.value
        )
    done = run("detect", "packed.xyz.gz", "--method", "plane", "--output", "made", cwd=tmp_path)
    assert done.returncode == 0 and os.listdir(tmp_path / "made") == ["packed.summary.json"]


def test_open_files_and_formats_by_name(cloud, tmp_path):
    content = (tmp_path / "cloud.xyz").read_bytes()
    np.testing.assert_array_equal(symsurf.read(io.BytesIO(content), "xyz").points, cloud)
    packed = io.BytesIO(gzip.compress(content))
    np.testing.assert_array_equal(symsurf.read(packed, "xyz.gz").points, cloud)
    (tmp_path / "cloud.dat").write_bytes(content)
    np.testing.assert_array_equal(symsurf.read(tmp_path / "cloud.dat", "XYZ").points, cloud)
    with pytest.raises(symsurf.InvalidParameter, match="format is None"):
        symsurf.read(io.BytesIO(content))
    for name in ("docx", "", ".gz", 3):
        with pytest.raises(symsurf.InvalidParameter, match="format is .*; allowed are ply obj"):
            symsurf.read(tmp_path / "cloud.dat", name)
    with pytest.raises(symsurf.InvalidInput, match=r"'.dat' is none of .ply .*symsurf\[formats\]"):
        symsurf.read(tmp_path / "cloud.dat")


def test_standard_input(cloud, tmp_path):
    command = [sys.executable, "-m", "symsurf", "align", "-", "--method", "plane", "--json"]
    with (tmp_path / "cloud.xyz").open() as content:
        done = subprocess.run(
            [*command, "--input-format", "xyz", "--output", "made"],
            stdin=content,
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=True,
        )
    assert json.loads(done.stdout)["points"] == len(cloud)
    np.testing.assert_array_equal(
        symsurf.read(tmp_path / "made/stdin.xyz").points,
        symsurf.align(cloud, symsurf.detect(cloud, "plane")).shape.points,
    )
    words = ("detect", "-", "--input-format", "ply", "--method", "plane")
    done = subprocess.run(
        [sys.executable, "-m", "symsurf", *words],
        input="no shape",
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1 and done.stderr.startswith("symsurf: stdin.ply: ")
    done = run("detect", "-")
    assert done.returncode == 2 and "needs --input-format" in done.stderr


def test_a_folder_is_the_files_in_it_that_can_be_read(cloud, tmp_path):
    folder = tmp_path / "scans"
    (folder / "more.xyz").mkdir(parents=True)
    for name in ("b.xyz", "a.XYZ"):
        np.savetxt(folder / name, cloud, fmt="%.17g")
    (folder / "notes.md").write_text("no points")
    done = run("detect", folder, "cloud.xyz", "--method", "plane", "--json", cwd=tmp_path)
    assert done.returncode == 0 and done.stderr == ""
    files = [json.loads(line)["file"] for line in done.stdout.splitlines()]
    assert files == [str(folder / "a.XYZ"), str(folder / "b.xyz"), "cloud.xyz"]
    assert [row["file"] for row in symsurf.batch([folder], method="plane")] == files[:2]
    with pytest.raises(symsurf.InvalidInput, match="this is not a file but a folder, with 2"):
        symsurf.read(folder)


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "utf-8"])
def test_what_the_terminal_cannot_encode_is_escaped(cloud, encoding, tmp_path, monkeypatch):
    name = os.fsdecode("→ä".encode() + b"\xff.xyz")
    np.savetxt(tmp_path / name, cloud, fmt="%.17g")
    monkeypatch.setenv("PYTHONIOENCODING", encoding)
    done = subprocess.run(
        [sys.executable, "-m", "symsurf", "detect", name, "--method", "plane"],
        cwd=tmp_path,
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0 and done.stderr == b""
    shown = {"ascii": rb"\u2192\xe4", "latin-1": b"\\u2192\xe4", "utf-8": "→ä".encode()}
    assert done.stdout.splitlines()[0] == shown[encoding] + b"\xff.xyz"
