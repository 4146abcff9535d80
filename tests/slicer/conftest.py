from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
MODULE = ROOT / "python" / "slicer" / "MirrorSymmetry"
HOSTS = Path(__file__).with_name("hosts")


@pytest.fixture(scope="session")
def slicer_python() -> Path:
    """A Python with slicer-core and symsurf."""
    own = ROOT / "build" / "slicer" / "bin" / "python"
    python = Path(os.environ.get("SYMSURF_SLICER_PYTHON", own))
    if not python.exists():
        pytest.skip(
            f"no Python with slicer-core at {python}: .ci/setup slicer makes it; SYMSURF_SLICER_PYTHON "
            "names another"
        )
    return python


@pytest.fixture
def in_slicer(slicer_python: Path) -> Callable[..., Any]:
    """Calls a function of ``hosts/scenes.py`` there and gives what it returns."""

    def call(name: str, *arguments: str) -> Any:
        done = subprocess.run(
            [slicer_python, HOSTS / "scenes.py", name, *arguments],
            env=os.environ
            | {"PYTHONPATH": f"{MODULE}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"},
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout.splitlines()[-1])

    return call
