"""Blender as a module of Python, in the environments that .ci/setup blender makes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

collect_ignore = ["inside"]  # which runs in Blender's Python

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "python/blender"))
WHEELS = [ROOT / "build" / each for each in ("wheels", "wheels/dist", "dist")]
PYTHONS = sorted((ROOT / "build").glob("blender-*/bin/python"))


class Blender(NamedTuple):
    """A Python that has Blender, and the extension for it."""

    python: Path
    zip: Path
    folder: Path
    """What the zip was made from."""

    @property
    def command_line(self) -> Path:
        """What `blender --command extension` runs."""
        (found,) = self.python.parents[1].glob(
            "lib/*/site-packages/bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
        )
        return found

    def run(self, user_folder: Path, *words: object) -> subprocess.CompletedProcess[str]:
        """Runs Blender's Python, with a folder for what Blender keeps of its user."""
        user_folder.mkdir(exist_ok=True)
        return subprocess.run(
            [str(word) for word in (self.python, *words)],
            env={"PATH": "/usr/bin:/bin", "BLENDER_USER_RESOURCES": str(user_folder)},
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )


@pytest.fixture(scope="session")
def zips(tmp_path_factory) -> dict[str, Path]:
    """The extension, by the tag of the Python that its wheel is for."""
    from build import build

    made: dict[str, Path] = {}
    for number, wheels in enumerate(WHEELS):
        for each in build(wheels, tmp_path_factory.mktemp(f"zips{number}")):
            (wheel,) = each.with_suffix("").glob("wheels/*.whl")
            made.setdefault(wheel.name.split("-")[2], each)
    return made


@pytest.fixture(scope="session", params=PYTHONS or [None], ids=lambda each: each and each.parts[-3])
def blender(request, zips) -> Blender:
    """Each Blender there is."""
    if request.param is None:
        pytest.skip("no Blender in build/blender-*: .ci/setup blender installs it")
    version = "import sys; print('cp%d%d' % sys.version_info[:2])"
    tag = subprocess.check_output([request.param, "-c", version], text=True).strip()
    if tag not in zips:
        pytest.skip(f"no wheel for {tag} in build/wheels or build/dist: make wheels builds it")
    return Blender(request.param, zips[tag], zips[tag].with_suffix(""))
