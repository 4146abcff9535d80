"""Systems that lack something, streams that are closed, and interrupts: no traceback, and no file at fault."""

from __future__ import annotations

import gzip
import io
import os
import shlex
import signal
import subprocess
import sys
import time
import zipfile

import numpy as np
import pytest
from symmetric_shapes import mirrored_surface

import symsurf
from symsurf.base import own_process

SYMSURF = [sys.executable, "-m", "symsurf"]
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
)


@pytest.fixture
def folder(tmp_path):
    for number in range(12):
        np.savetxt(tmp_path / f"{number:02}.xyz", mirrored_surface(300, number)[0])
    return tmp_path


# What a Python on Windows lacks, as modules and functions.
ELSEWHERE = """
import os, signal, sys
for name in ("resource", "fcntl", "pwd", "grp"):
    sys.modules[name] = None
for name in ("sysconf", "fork", "register_at_fork", "sched_getaffinity", "chown", "geteuid", "mkfifo"):
    if hasattr(os, name):
        delattr(os, name)
for name in ("SIGPIPE", "SIGALRM", "SIGXCPU", "setitimer"):
    if hasattr(signal, name):
        delattr(signal, name)
"""


def test_without_what_windows_lacks(folder):
    """Each kind of reader, a stream, jobs and a table."""
    pyvista = pytest.importorskip("pyvista")
    trimesh = pytest.importorskip("trimesh")
    points = mirrored_surface(300, 0)[0]
    faces = np.arange(300).reshape(-1, 3)
    mesh = trimesh.Trimesh(points, faces, process=False)
    for suffix in ("glb", "3mf", "stl", "obj"):
        mesh.export(folder / f"mesh.{suffix}")
    pyvista.PolyData.from_regular_faces(points, faces).save(folder / "mesh.vtp")
    (folder / "cloud.ply.gz").write_bytes(gzip.compress(PLY.encode()))
    script = folder / "script.py"
    script.write_text(
        f"{ELSEWHERE}\n"
        "import io, symsurf\n"
        "from pathlib import Path\n"
        "from symsurf.cli import main\n"
        "for name in ('mesh.glb', 'mesh.3mf', 'mesh.stl', 'mesh.obj', 'mesh.vtp', 'cloud.ply.gz'):\n"
        "    assert len(symsurf.read(name).points) in (4, 300), name\n"
        f"symsurf.read(io.BytesIO({PLY.encode()!r}), 'ply')\n"
        "raise SystemExit(main(['detect', *map(str, Path().glob('*.xyz')), '--jobs', '2', '--method',\n"
        "                       'plane', '--table', 't.csv', '--output', 'made']))\n"
    )
    done = subprocess.run(
        [sys.executable, script], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0 and done.stderr == ""
    assert (folder / "t.csv").read_text().count("\n") == 13


def test_without_a_python_to_start_chunks_are_read_here(tmp_path, monkeypatch):
    pytest.importorskip("pyvista")
    import pyvista

    monkeypatch.setattr(own_process, "_python", lambda: None)
    pyvista.PolyData(mirrored_surface(300, 0)[0]).save(tmp_path / "piece.vtp")
    (tmp_path / "a.pvtp").write_text(
        '<VTKFile type="PPolyData"><PPolyData><Piece Source="piece.vtp"/></PPolyData></VTKFile>'
    )
    assert symsurf.summarize(tmp_path / "a.pvtp").count == 300
    (tmp_path / "a.pvtp").write_text("no XML")
    with pytest.raises(symsurf.InvalidInput, match="broken PVTP"):
        symsurf.summarize(tmp_path / "a.pvtp")


@pytest.mark.parametrize(
    ("words", "closed", "status"),
    [
        ("detect 00.xyz --method plane --table t.csv", ">&-", 0),
        ("detect 00.xyz 01.xyz --method plane --jobs 2 --output made", ">&- <&- 2>&-", 0),
        ("detect 00.xyz none.xyz --method plane", ">&- 2>&-", 1),
        ("detect 00.xyz --speed 1", "2>&-", 2),
        ("methods", ">&-", 0),
        ("--help", ">&-", 0),
        ("detect - --input-format xyz", "<&-", 2),
    ],
)
def test_closed_streams(words, closed, status, folder):
    command = f"{shlex.join(SYMSURF)} {words} {closed}"
    done = subprocess.run(
        ["bash", "-c", command], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == status
    assert "Traceback" not in done.stderr and done.stderr.count("\n") <= 1
    if words.startswith("detect -"):
        assert "standard input" in done.stderr
    if "--table" in words:
        assert (folder / "t.csv").read_text().count("\n") == 2
    if "--output" in words:
        assert len(list((folder / "made").iterdir())) == 2


@pytest.mark.parametrize("jobs", ["1", "3"])
def test_an_interrupt_has_a_status_and_no_traceback(jobs, folder):
    """What was written by then is whole, and no process is left."""
    for number in range(12, 200):
        (folder / f"{number:03}.xyz").symlink_to("00.xyz")
    for attempt in range(3):
        table = folder / f"t{attempt}.csv"
        words = ["detect", ".", "--method", "plane", "--jobs", jobs, "--table", table]
        with subprocess.Popen(
            [*SYMSURF, *words], cwd=folder, stdout=-3, stderr=-1, text=True, start_new_session=True
        ) as run:
            while not table.exists():
                time.sleep(0.01)
            os.killpg(run.pid, signal.SIGINT)
            os.killpg(run.pid, signal.SIGINT)
            said = run.communicate(timeout=60)[1]
        assert run.returncode == 130 and said == ""
        rows = table.read_text().splitlines()
        assert 1 < len(rows) < 200 and not any("died" in row for row in rows)
        with pytest.raises(ProcessLookupError):
            os.killpg(run.pid, 0)


def test_a_zip_without_a_model_and_a_stream_that_fails(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.3mf", "w") as archive:
        archive.writestr("a.txt", "no model")
    with pytest.raises(symsurf.InvalidInput, match="no file 3D/3dmodel.model"):
        symsurf.read(tmp_path / "a.3mf")

    class Failing(io.BytesIO):
        def read(self, *size: int) -> bytes:
            raise OSError(5, "Input/output error")

    with pytest.raises(symsurf.InvalidInput, match="Input/output error"):
        symsurf.read(Failing(), "ply")
