"""Runs scripts inside ParaView's own programs; every test here needs the built plugin."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent
BUILD = Path(os.environ.get("SYMSURF_PARAVIEW_BUILD", HERE.parents[1] / "build" / "paraview"))
SHAPES = Path(os.environ.get("SYMSURF_SHAPES", HERE.parents[2] / "shared" / "data"))


def _existing(pattern: str) -> Path:
    found = sorted(BUILD.glob(pattern))
    if not found:
        pytest.skip(f"{BUILD} has no {pattern}: make paraview builds it")
    return found[0]


@pytest.fixture(scope="session")
def plugin() -> Path:
    return _existing("lib/paraview-*/plugins/SymsurfPlugin/SymsurfPlugin.so")


@pytest.fixture(scope="session")
def server_manager_xml() -> Path:
    return _existing("vtk_filters/paraview/MirrorDetection.xml").parent


@pytest.fixture
def environment(plugin: Path, tmp_path: Path) -> dict[str, str]:
    """A home of its own, so that neither settings nor plugins of the user take part."""
    runtime = tmp_path / "runtime"
    runtime.mkdir(mode=0o700)
    modules = next(BUILD.glob("lib/python3*/site-packages"), None)
    return os.environ | {
        "HOME": str(tmp_path),
        "XDG_RUNTIME_DIR": str(runtime),
        "SYMSURF_PLUGIN": str(plugin),
        "PYTHONPATH": str(modules or ""),
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    }


@pytest.fixture
def run_host(environment: dict[str, str], tmp_path: Path) -> Callable[..., Any]:
    """run_host(command, script, *arguments): what the script leaves in the JSON file that its
    first argument names; `command` is a host's command line ("mpiexec -n 2 pvbatch")."""

    def run(command: str, script: str, *arguments: object, timeout: float = 120) -> Any:
        programs = command.split()
        for program in (programs[0], programs[-1]):
            if not program.startswith("-") and shutil.which(program) is None:
                pytest.skip(f"{program} is not installed")
        answer = tmp_path / f"{script}.json"
        answer.unlink(missing_ok=True)
        done = subprocess.run(
            [*programs, str(HERE / "hosts" / script), str(answer), *map(str, arguments)],
            env=environment,
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return json.loads(answer.read_text())

    return run


@pytest.fixture
def shape_file() -> Path:
    """A real scan-like mesh; the tests that need one skip without it."""
    path = SHAPES / "spot.obj"
    if not path.exists():
        pytest.skip(f"{path} is not there")
    return path
