"""The files themselves: what they export, what they need, and hosts written in C++."""

from __future__ import annotations

import functools
import os
import subprocess
from pathlib import Path

import numpy as np
import pymeshlab
import pytest
from conftest import BUILD, plugin_file

LIBRARIES = {
    "double": Path(pymeshlab.__file__).parent / "lib",
    "float": BUILD.parent / "meshlab-gui" / "src" / "distrib",
}


def symbols(file: Path, *options: str) -> set[str]:
    command = ["nm", "--dynamic", "--format=just-symbols", *options, file]
    listed = subprocess.run(command, check=True, capture_output=True, text=True)
    return {line.split("@")[0] for line in listed.stdout.splitlines()}


def needed_from_meshlab(scalar: str) -> set[str]:
    needed = symbols(plugin_file(scalar), "--undefined-only", "--demangle")
    of_meshlab = {name for name in needed if "Rich" in name or "Mesh" in name or "vcg" in name}
    return {name for name in of_meshlab if "OpenMesh::" not in name}  # of the core's library


@pytest.mark.parametrize("scalar", ["double", "float"])
def test_only_the_entry_points_of_qt_are_exported(scalar):
    exported = symbols(plugin_file(scalar), "--defined-only")
    assert exported == {"qt_plugin_instance", "qt_plugin_query_metadata"}


def test_meshlab_has_what_the_double_build_needs():
    library = LIBRARIES["double"] / "libmeshlab-common.so"
    offered = symbols(library, "--defined-only", "--demangle")
    needed = needed_from_meshlab("double")
    assert needed and needed <= offered


def test_the_float_build_needs_the_same_with_float():
    of_double = {name.replace("double", "float") for name in needed_from_meshlab("double")}
    assert needed_from_meshlab("float") == of_double


def test_a_double_host_refuses_the_float_build(float_plugin):
    with pytest.raises(pymeshlab.PyMeshLabException, match="different floating point precision"):
        pymeshlab.load_plugin(str(float_plugin))


@functools.cache
def in_host(scalar: str) -> subprocess.CompletedProcess:
    host = BUILD / "meshlab" / f"meshlab_host_{scalar}"
    if not host.exists():
        pytest.skip(f"no MeshLab library with {scalar} numbers to test with: make meshlab-gui")
    return subprocess.run(
        [host, plugin_file(scalar)],
        env=os.environ | {"LD_LIBRARY_PATH": str(LIBRARIES[scalar])},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("scalar", ["double", "float"])
def test_in_a_host_that_cancels_and_throws(scalar):
    run = in_host(scalar)
    assert run.returncode == 0, run.stdout + run.stderr


def test_the_float_build_finds_the_same_planes():
    found = {}
    for scalar in ("float", "double"):
        lines = map(str.split, in_host(scalar).stdout.splitlines())
        found[scalar] = {
            (name, figure): np.array(values, float)
            for name, figure, *values in lines
            if figure == "matrix" and len(values) == 16  # of a plane; a quadric's has nine
        }
    assert found["double"] and found["double"].keys() == found["float"].keys()
    # The lump of the host lies at the origin and is about 40 across.
    for key, matrix in found["double"].items():
        difference = np.abs(found["float"][key] - matrix).reshape(4, 4)
        assert difference[:3, :3].max() < 1e-5 and difference[:3, 3].max() < 1e-5 * 40
