"""What `cmake --install` leaves: the plugin, wherever it is copied to, and the Python wrapping."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import BUILD


@pytest.fixture(scope="module")
def prefix(plugin: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("prefix")
    command = ["cmake", "--install", str(BUILD), "--prefix", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def installed_plugin(prefix: Path) -> Path:
    (file,) = prefix.glob("lib*/**/SymsurfPlugin.so")
    return file


@pytest.fixture
def nothing_else(environment: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """No path leads to the build."""
    del environment["PYTHONPATH"]
    for name in ("LD_LIBRARY_PATH", "PYTHONPATH", "PV_PLUGIN_PATH"):
        monkeypatch.delenv(name, raising=False)
        environment.pop(name, None)
    return environment


def test_plugin_where_it_is_installed(
    prefix: Path, nothing_else: dict[str, str], run_host: Callable[..., Any]
) -> None:
    nothing_else["SYMSURF_PLUGIN"] = str(installed_plugin(prefix))
    assert run_host("pvpython", "reflection.py") < 1e-6


def test_plugin_copied_elsewhere_by_itself(
    prefix: Path, nothing_else: dict[str, str], run_host: Callable[..., Any], tmp_path: Path
) -> None:
    copy = tmp_path / "plugins of mine" / "SymsurfPlugin.so"
    copy.parent.mkdir()
    shutil.copy(installed_plugin(prefix), copy)
    nothing_else["SYMSURF_PLUGIN"] = str(copy)
    assert run_host("pvpython", "reflection.py") < 1e-6


def test_wrapping_beside_the_plugin(
    prefix: Path, nothing_else: dict[str, str], run_host: Callable[..., Any]
) -> None:
    (modules,) = prefix.glob("lib*/python3*/site-packages")
    nothing_else |= {
        "SYMSURF_PLUGIN": str(installed_plugin(prefix)),
        "PYTHONPATH": str(modules),
    }
    values = {"PlanePairDistance": 0.125}
    said = run_host("pvpython", "properties.py", json.dumps({"MirrorDetection": values}))
    assert said["MirrorDetection"]["after"] == values
