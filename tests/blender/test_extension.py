"""The extension in Blender, from its zip."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest

INSIDE = Path(__file__).parent / "inside"


@pytest.mark.parametrize("file", sorted(INSIDE.glob("test_*.py")), ids=lambda each: each.stem)
def test_inside(blender, tmp_path, file):
    pytest_ = ["-m", "pytest", "-q", "--tb=short", "--show-capture=no", "-p", "no:cacheprovider"]
    done = blender.run(tmp_path / "user", *pytest_, "--zip", blender.zip, file)
    assert done.returncode == 0, done.stdout[-6000:] + done.stderr[-2000:]
    assert " passed" in done.stdout or "100%" in done.stdout


def test_blenders_command_line_validates_and_builds_it(blender, tmp_path):
    validated = blender.run(tmp_path / "user", blender.command_line, "validate", blender.zip)
    assert validated.returncode == 0, validated.stdout
    built = blender.run(
        tmp_path / "user",
        *(blender.command_line, "build", "--source-dir", blender.folder),
        *("--output-dir", tmp_path, "--split-platforms"),
    )
    assert built.returncode == 0, built.stdout
    (other,) = tmp_path.glob("*.zip")
    names = [
        {each for each in zipfile.ZipFile(path).namelist() if not each.endswith("/")}
        for path in (other, blender.zip)
    ]
    assert names[0] == names[1]


def test_scan_is_symmetric_from_the_zip_on(blender, tmp_path):
    done = blender.run(tmp_path / "user", INSIDE / "from_zip.py", blender.zip)
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout.splitlines()[-1])
    print(said)  # with the seconds that it took
    assert said["vertices"] == 100_000
    assert said["asymmetry"] < 1e-6 and said["partners_are_mutual"]
    assert said["texture"] == pytest.approx(said["texture_before"], abs=0.02)
    assert said["quadrilaterals"] > 99_000
