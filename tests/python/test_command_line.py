"""The command line, run as users run it."""

from __future__ import annotations

import json
import os
import pty
import subprocess
import sys

import numpy as np
import pytest
from command_line import run, run_here
from symmetric_shapes import mirrored_surface

import symsurf


@pytest.fixture
def clouds(tmp_path):
    """Three files of one symmetric shape each, and their points."""
    files = {}
    for seed in range(3):
        path = tmp_path / f"shape{seed}.xyz"
        files[path], _ = mirrored_surface(600, seed)
        np.savetxt(path, files[path], fmt="%.17g")
    return files


def test_json_is_an_object_a_line(clouds):
    done = run("detect", *clouds, "--method", "plane", "--json")
    assert done.returncode == 0 and done.stderr == ""
    records = [json.loads(line) for line in done.stdout.splitlines()]
    assert [record["file"] for record in records] == [str(path) for path in clouds]
    for record, points in zip(records, clouds.values()):
        result = symsurf.detect_plane(points)
        assert record["mirror"] == {
            "kind": "plane",
            "normal": result.mirror.normal.tolist(),
            "offset": result.mirror.offset,
        }
        assert record["points"] == len(points) and record["score"] == result.score


def test_the_same_as_in_python(clouds):
    path = next(iter(clouds))
    words = ("--max-candidates", "0", "--pair_distance", "1e-3", "--seed", "3", "--threads", "1")
    record = json.loads(run("detect", path, "--method", "plane", *words, "--json").stdout)
    result = symsurf.detect_plane(
        symsurf.read(path).points, max_candidates=0, pair_distance=1e-3, seed=3
    )
    assert record["mirror"]["normal"] == result.mirror.normal.tolist()
    assert record["mirror"]["offset"] == result.mirror.offset
    assert record["parameters"] == result.parameters
    assert record["pairs"] == len(result.pairs) and record["score"] == result.score


def test_normals_of_a_file_are_used_where_asked_for(tmp_path):
    points, _ = mirrored_surface(600, 0)
    normals = np.random.default_rng(0).normal(size=points.shape)
    np.savetxt(tmp_path / "cloud.xyz", np.hstack([points, normals]), fmt="%.17g")
    np.savetxt(tmp_path / "bare.xyz", points, fmt="%.17g")
    shape = symsurf.read(tmp_path / "cloud.xyz")
    options = "--method normals_only --json"
    for words, given in (("", None), ("--use-normals", shape.normals)):
        record = json.loads(run_here(f"detect cloud.xyz {options} {words}", tmp_path).stdout)
        expected = symsurf.detect(points, "normals_only", normals=given)
        assert record["median_residual"] == np.median(expected.residuals)
    done = run_here(f"detect cloud.xyz bare.xyz {options} --use-normals", tmp_path)
    assert done.returncode == 1 and len(done.stdout.splitlines()) == 1
    assert done.stderr.startswith("symsurf: bare.xyz: use_normals is given, but the file has no")
    done = run_here(f"detect cloud.xyz {options} --use-normals --downsample 2", tmp_path)
    assert done.returncode == 2 and "use_normals is given beside downsample" in done.stderr


def test_a_reader_that_has_seen_enough_is_no_failure():
    command = [sys.executable, "-m", "symsurf", "methods"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 128 + 13


def test_one_failed_file_does_not_stop_the_rest(clouds, tmp_path):
    first, second, third = clouds
    second.write_text("not a cloud")
    done = run("detect", first, tmp_path / "none.ply", second, third, "--json")
    assert done.returncode == 1
    assert [json.loads(line)["file"] for line in done.stdout.splitlines()] == [
        str(first),
        str(third),
    ]
    errors = done.stderr.splitlines()
    assert len(errors) == 2
    assert "none.ply" in errors[0] and second.name in errors[1]
    assert "Traceback" not in done.stderr


def test_report_for_people(clouds):
    done = run("detect", *clouds)
    assert done.returncode == 0 and done.stderr == ""
    for path in clouds:
        assert str(path) in done.stdout
    assert done.stdout.count("\n  score ") == len(clouds)


def test_output_folder(clouds, tmp_path):
    folder = tmp_path / "new" / "results"
    done = run("detect", *clouds, "--output", folder, "--json")
    assert {path.name for path in folder.iterdir()} == {
        f"{path.stem}.summary.json" for path in clouds
    }
    for path, line in zip(clouds, done.stdout.splitlines()):
        saved = json.loads((folder / f"{path.stem}.summary.json").read_text())
        told = json.loads(line)
        del told["seconds_in_all"]
        assert saved == told
    chosen = tmp_path / "chosen"
    formats = "json,vtp,ply,txt,summary.json"
    assert run("detect", *clouds, "--output", chosen, "--formats", formats).returncode == 0
    expected = {f"{path.stem}.{kind}" for path in clouds for kind in formats.split(",")}
    assert {path.name for path in chosen.iterdir()} == expected


def test_pictures(clouds, tmp_path):
    pytest.importorskip("pyvista")
    path = next(iter(clouds))
    assert run("detect", path, "--output", tmp_path / "made", "--plot").returncode == 0
    picture = tmp_path / "made" / f"{path.stem}.png"
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_files_that_would_overwrite_each_other_are_refused(clouds, tmp_path):
    path = next(iter(clouds))
    twin = tmp_path / "other" / path.name
    twin.parent.mkdir()
    twin.write_text(path.read_text())
    done = run("detect", path, twin, "--output", tmp_path / "results")
    assert done.returncode == 2 and path.stem in done.stderr and done.stdout == ""
    assert not (tmp_path / "results").exists()


def test_files_to_read_are_not_written(clouds, tmp_path):
    mesh = tmp_path / "mesh.ply"
    symsurf.detect(clouds[next(iter(clouds))], "plane").save(mesh)
    before = mesh.read_bytes()
    linked = tmp_path / "linked"
    linked.symlink_to(tmp_path)
    names = os.listdir(tmp_path)
    for folder in tmp_path, linked:
        words = ("--formats", "ply", "--output", folder)
        done = run("detect", *clouds, "mesh.ply", *words, cwd=tmp_path)
        assert done.returncode == 2 and done.stdout == ""
        assert "mesh.ply would overwrite an input" in done.stderr
        assert os.listdir(tmp_path) == names and mesh.read_bytes() == before


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--method", "magic"], "'magic'"),
        (["--method", "plane", "--pair-distance", "-1"], "pair_distance is -1"),
        (["--method", "plane", "--pair-distance", "-1e-3"], "pair_distance is -0.001"),
        (["--method", "plane", "--pair-distance", "far"], "pair_distance is far"),
        (["--method", "plane", "--sample-size", "1.5"], "sample_size is 1.5"),
        (["--method", "auto", "--pair-distance", "0.1"], "no parameter 'pair_distance'"),
        (["--threads", "-1"], "threads is -1"),
        (["--seed", "x"], "seed is 'x'"),
        (["--formats", "docx", "--output", "."], "docx"),
        (["--magic", "1"], "--magic"),
    ],
)
def test_bad_options_are_one_error(clouds, words, says):
    done = run("detect", *clouds, *words)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.count(says) == 1
    assert "Traceback" not in done.stderr


def test_progress_only_on_a_terminal(clouds):
    path = next(iter(clouds))
    ours, theirs = pty.openpty()
    done = subprocess.run(
        [sys.executable, "-m", "symsurf", "detect", str(path), "--json"],
        stdout=subprocess.PIPE,
        stderr=theirs,
        timeout=120,
        check=False,
    )
    os.close(theirs)
    bar = os.read(ours, 1 << 16).decode()
    os.close(ours)
    assert path.name in bar and "100%" in bar
    assert json.loads(done.stdout)["file"] == str(path)


def test_version_and_help():
    assert run("--version").stdout.split() == ["symsurf", symsurf.__version__]
    assert run().stdout == run("--help").stdout
    for command in ("detect", "methods", "demo"):
        done = run(command, "--help")
        assert done.returncode == 0 and "usage" in done.stdout
