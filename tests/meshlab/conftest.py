"""The real host: MeshLab's engine, as pymeshlab carries it, with the plugin loaded."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

pymeshlab = pytest.importorskip("pymeshlab", reason="pymeshlab is not installed")

VERSION = os.environ.get("SYMSURF_MESHLAB_VERSION", "2025.07")
BUILD = Path(
    os.environ.get("SYMSURF_MESHLAB_BUILD", Path(__file__).parents[2] / "build" / "meshlab")
)


def plugin_file(scalar: str) -> Path:
    file = BUILD / "meshlab" / f"{VERSION}-{scalar}" / "filter_symsurf.so"
    if not file.exists():
        pytest.skip(f"the MeshLab plugin is not built ({file} is missing): make meshlab")
    return file


@pytest.fixture(scope="session")
def double_plugin() -> Path:
    return plugin_file("double")


@pytest.fixture(scope="session")
def float_plugin() -> Path:
    return plugin_file("float")


@pytest.fixture(scope="session", autouse=True)
def loaded(double_plugin: Path) -> None:
    pymeshlab.load_plugin(str(double_plugin))
