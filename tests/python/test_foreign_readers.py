"""Readers of other libraries, which a file may kill: it costs that file alone."""

from __future__ import annotations

import gzip
import os
import struct
import subprocess
import sys

import numpy as np
import pytest
from dialects import POINTS, clouds, data_sets

import symsurf
from symsurf.base import own_process
from symsurf.base.own_process import ProcessDied, call
from symsurf.reading.formats import FORMATS


@pytest.mark.parametrize("name", data_sets.LYING)
def test_a_data_set_that_promises_more_than_it_holds(name, tmp_path):
    path = tmp_path / name
    path.write_bytes(data_sets.LYING[name])
    try:  # cells that are promised, but have no place in the file, are no cells
        assert len(symsurf.read(path, threshold=0 if "image" in name else None).points) == 1
        assert name in ("polygons.vtp", "verts.vtp")
    except symsurf.InvalidInput as error:
        assert str(error).startswith(f"{path}: ")


@pytest.mark.parametrize("count", [10**6, 2**32 - 1])
@pytest.mark.parametrize("at", [100, 107])  # of the records before the points, and of the points
def test_a_packed_scan_that_promises_more_than_it_holds(count, at, tmp_path):
    suffix, write = clouds.LAS["packed"]
    path = tmp_path / f"scan{suffix}"
    write(path)
    content = bytearray(path.read_bytes())
    content[at : at + 4] = struct.pack("<I", count)
    path.write_bytes(content)
    with pytest.raises(symsurf.InvalidInput, match="scan.laz: "):
        symsurf.read(path)


def test_what_may_die_has_a_process_of_its_own(tmp_path, monkeypatch):
    """Readers of others, and whatever unpacks."""
    begun = []

    class Watched(own_process.Processes):
        def call(self, *given, **limits):
            begun.append(given[3])
            return super().call(*given, **limits)

    with Watched() as processes:
        monkeypatch.setattr(own_process, "call", processes.call)
        for suffix in (*FORMATS, *(f"{suffix}.gz" for suffix in FORMATS)):
            path = tmp_path / f"a{suffix}"
            path.write_bytes(gzip.compress(b"none") if suffix.endswith(".gz") else b"none")
            with pytest.raises(symsurf.InvalidInput, match=f"a{suffix}"):
                symsurf.read(path)
            others = (".vtp", ".vtu", ".vti", ".vtk", ".laz", ".nrrd", ".nii", ".3mf")
            assert len(begun) == (suffix.endswith((".gz", *others)))
            begun.clear()


def test_a_process_that_died_is_followed_by_another():
    assert call("os", "getpid") == call("os", "getpid") != os.getpid()
    before = call("os", "getpid")
    with pytest.raises(ProcessDied):
        call("os", "abort")
    assert call("os", "getpid") != before


def test_it_raises_what_was_raised_there():
    with pytest.raises(symsurf.InvalidInput, match="nowhere.ply: there is no such file"):
        call("symsurf", "read", "nowhere.ply")
    with pytest.raises(RuntimeError, match="3"):
        call("sys", "exit", 3)


def test_a_call_that_takes_too_long_is_ended():
    call("os", "getpid")
    with pytest.raises(ProcessDied):
        call("time", "sleep", 60, seconds=0.1)


def test_memory_beyond_that_of_the_machine_is_refused_there():
    bytes_of_machine = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    with pytest.raises(MemoryError):
        call("numpy", "empty", 2 * bytes_of_machine, "u1")
    with pytest.raises(MemoryError):
        call("numpy", "empty", 4 << 30, "u1", memory=2 << 30)


def test_nothing_of_the_script_runs_twice(tmp_path):
    suffix, write = data_sets.VTK["XML"]
    write(tmp_path / f"mesh{suffix}")
    script = tmp_path / "script.py"
    script.write_text(
        "import symsurf\nopen('runs', 'a').write('once ')\n"
        "print(len(symsurf.read('mesh.vtp').points), flush=True)\n"
    )
    done = subprocess.run(
        [sys.executable, script], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stdout == f"{len(POINTS)}\n" and done.stderr == ""
    assert (tmp_path / "runs").read_text() == "once "


def test_where_no_python_is_to_run_it_runs_here(monkeypatch):
    monkeypatch.setattr(own_process, "_python", lambda: None)
    assert call("os", "getpid") == os.getpid()


def test_points_come_over_whole(tmp_path):
    suffix, write = data_sets.VTK["XML"]
    write(tmp_path / f"mesh{suffix}")
    shape = symsurf.read(tmp_path / f"mesh{suffix}")
    assert shape.points.flags.writeable and shape.points.dtype == np.float64
