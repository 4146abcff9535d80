"""How the zips are made of whatever wheels there are; needs no Blender."""

from __future__ import annotations

import zipfile

import pytest
from build import build, platform_of

NAMES = [
    "symsurf-0.1.0-cp311-cp311-manylinux_2_28_x86_64.whl",
    "symsurf-0.1.0-cp313-cp313-win_amd64.whl",
    "symsurf-0.1.0-cp312-cp312-macosx_11_0_arm64.whl",
]


@pytest.fixture
def made(tmp_path):
    for name in NAMES:
        with zipfile.ZipFile(tmp_path / name, "w") as wheel:
            wheel.writestr("symsurf/__init__.py", "")
    return {path.name: zipfile.ZipFile(path) for path in build(tmp_path, tmp_path / "made")}


def test_a_zip_for_each_blender_that_a_wheel_fits(made):
    assert set(made) == {
        "symsurf-0.1.0-blender-4.2.0-linux_x64.zip",
        "symsurf-0.1.0-blender-5.1.0-windows_x64.zip",
    }


def test_manifest_says_what_it_is_for(made):
    old = made["symsurf-0.1.0-blender-4.2.0-linux_x64.zip"].read("blender_manifest.toml").decode()
    new = made["symsurf-0.1.0-blender-5.1.0-windows_x64.zip"].read("blender_manifest.toml").decode()
    assert 'blender_version_min = "4.2.0"\nblender_version_max = "5.1.0"' in old
    assert 'platforms = ["linux-x64"]' in old and f'wheels = ["./wheels/{NAMES[0]}"]' in old
    assert 'blender_version_min = "5.1.0"\nplatforms = ["windows-x64"]' in new
    for text in (old, new):
        assert '"SPDX:GPL-3.0-or-later"' in text and "@" not in text


def test_every_zip_has_the_licence_and_the_whole_extension(made):
    for archive in made.values():
        names = set(archive.namelist())
        assert {"LICENSE", "__init__.py", "operators.py", "panel.py"} <= names
        assert len([name for name in names if name.endswith(".whl")]) == 1


@pytest.mark.parametrize(
    ("tag", "platform"),
    [
        ("manylinux2014_aarch64", "linux-arm64"),
        ("manylinux_2_17_x86_64.manylinux2014_x86_64", "linux-x64"),
        ("win_arm64", "windows-arm64"),
        ("macosx_11_0_arm64", "macos-arm64"),
        ("macosx_10_9_x86_64", "macos-x64"),
        ("any", None),
    ],
)
def test_platforms_have_blenders_names(tag, platform):
    assert platform_of(tag) == platform
