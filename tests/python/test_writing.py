"""Every writer on a full disk, in a folder it may not write to, and killed: whole files or none."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from command_line import run_here

import symsurf

NOBODY = 65534


@pytest.fixture(scope="module")
def result() -> symsurf.Result:
    half = np.random.default_rng(1).normal(size=(100, 3))
    return symsurf.match(np.vstack([half, half * (-1, 1, 1)]), symsurf.Plane((1, 0, 0), 0))


@pytest.fixture
def open_folder() -> Iterator[Path]:
    """One that every user may enter, unlike pytest's own."""
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o755)
    yield folder
    shutil.rmtree(folder)


Write = Callable[[symsurf.Result, Path], None]


def saved(suffix: str) -> Write:
    return lambda result, folder: result.save(folder / f"written{suffix}")


def drawn(result: symsurf.Result, folder: Path) -> None:
    pytest.importorskip("pyvista")
    result.plot(folder / "written.png")


def command(line: str) -> Write:
    def write(result: symsurf.Result, folder: Path) -> None:
        done = run_here(line.format(folder=folder), folder.parent)
        assert "Traceback" not in done.stderr
        if done.returncode != 0:
            assert len(done.stderr.splitlines()) == 1
            raise OSError(done.stderr)

    return write


WRITERS: dict[str, tuple[Write, str]] = {
    "json": (saved(".json"), "written.json"),
    "vtp": (saved(".vtp"), "written.vtp"),
    "ply": (saved(".ply"), "written.ply"),
    "txt": (saved(".txt"), "written.txt"),
    "picture": (drawn, "written.png"),
    "detect": (
        command("detect written.xyz --method plane --formats vtp --output {folder}"),
        "written.vtp",
    ),
    "summary": (
        command("detect written.xyz --method plane --output {folder}"),
        "written.summary.json",
    ),
    "table": (
        command("detect written.xyz --method plane --table {folder}/written.csv"),
        "written.csv",
    ),
    "align": (command("align written.xyz --method plane --output {folder}"), "written.xyz"),
    "generate": (command("generate spherical --output {folder}/written.csv"), "written.csv"),
    "damage": (
        command("damage rotation written.xyz --roll 5 --output {folder}/written.txt"),
        "written.txt",
    ),
}


@contextmanager
def full_disk() -> Iterator[None]:
    """No file of this process may have more than a few bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (16, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@contextmanager
def read_only(folder: Path) -> Iterator[None]:
    """Root may write everywhere; it becomes somebody who may not."""
    folder.chmod(0o555)
    is_root = os.geteuid() == 0
    try:
        if is_root:
            os.seteuid(NOBODY)
        yield
    finally:
        if is_root:
            os.seteuid(0)
        folder.chmod(0o755)


@pytest.fixture(params=WRITERS)
def writer(request, result, open_folder) -> tuple[Callable[[], None], Path]:
    """A writer, and the file that it writes, which stands there already."""
    write, name = WRITERS[request.param]
    folder = open_folder / "folder"
    folder.mkdir()
    np.savetxt(open_folder / "written.xyz", result.points)
    (open_folder / "written.xyz").chmod(0o644)
    write(result, folder)  # what can be written, and loads what drawing needs
    for path in folder.iterdir():
        path.unlink()
    (folder / name).write_text("precious")
    return lambda: write(result, folder), folder / name


def test_full_disk(writer):
    write, path = writer
    with full_disk(), pytest.raises(OSError, match=path.name):
        write()
    assert path.read_text() == "precious" and list(path.parent.iterdir()) == [path]


def test_folder_that_may_not_be_written_to(writer):
    write, path = writer
    with read_only(path.parent), pytest.raises(OSError, match=rf"(?s)ermission.*{path.name}"):
        write()
    assert path.read_text() == "precious" and list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("folder", ["none/written", "file"])
def test_no_folder(writer, folder, request):
    write, path = writer
    shutil.rmtree(path.parent)
    if folder == "file":
        path.parent.write_text("in the way")
    elif request.node.callspec.params["writer"] in ("detect", "summary", "table", "align"):
        pytest.skip("commands for many files make the folder")
    with pytest.raises(OSError, match=f"{path.parent}"):
        write()


def test_link(writer):
    """It stays one, and its file is written."""
    write, path = writer
    file = path.parent.parent / f"elsewhere{path.suffix}"
    path.replace(file)
    path.symlink_to(file)
    write()
    assert path.is_symlink() and file.stat().st_size > len("precious")
    assert not list(path.parent.parent.glob("**/*.partial"))


def test_pipe_in_the_way(writer):
    write, path = writer
    path.unlink()
    os.mkfifo(path)
    with pytest.raises(OSError, match=rf"not a file.*{path.name}"):
        write()
    assert path.is_fifo() and list(path.parent.iterdir()) == [path]


KILLED = """
import sys, numpy, symsurf
from pathlib import Path
half = numpy.random.default_rng(1).normal(size=(300000, 3))
points = numpy.vstack([half, half * (-1, 1, 1)])
result = symsurf.match(points, symsurf.Plane((1, 0, 0), 0))
while True:
    result.save(sys.argv[1])
"""


@pytest.mark.parametrize("suffix", [".ply", ".vtp"])
def test_killed_while_it_writes(suffix, tmp_path):
    path = tmp_path / f"written{suffix}"
    with subprocess.Popen([sys.executable, "-c", KILLED, str(path)]) as process:
        end = time.monotonic() + 60
        try:
            while not [p for p in tmp_path.iterdir() if p != path]:
                assert time.monotonic() < end and process.poll() is None
        finally:
            process.kill()
    if path.exists():  # the file of an earlier round, whole
        content = path.read_bytes()
        rows = content.partition(b"end_header\n")[2]
        assert content.endswith(b"</VTKFile>\n") if suffix == ".vtp" else len(rows) % 32 == 0
    assert not [p for p in tmp_path.iterdir() if p != path and not p.name.startswith(".")]


@pytest.mark.parametrize("line", ["methods", "methods --json", "--help", "detect --help"])
def test_standard_output_that_is_full(line):
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "symsurf", *line.split()],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=120,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr == "symsurf: [Errno 28] No space left on device: 'standard output'\n"


def test_standard_output_that_is_full_is_no_fault_of_the_files(tmp_path, result):
    files = []
    for name in ("a.xyz", "b.xyz"):
        np.savetxt(tmp_path / name, result.points)
        files.append(tmp_path / name)
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-u", "-m", "symsurf", "detect", *map(str, files)],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=120,
            check=False,
        )
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "standard output" in done.stderr and "a.xyz" not in done.stderr


def test_pictures_are_png(result, tmp_path):
    with pytest.raises(symsurf.InvalidParameter, match=r"result\.jpg.*allowed is the suffix \.png"):
        result.plot(tmp_path / "result.jpg")
    assert not list(tmp_path.iterdir())


def test_two_who_save_one_file_leave_a_whole_one(result, tmp_path):
    path = tmp_path / "same.json"
    result.save(path)
    whole = path.read_bytes()
    torn = []

    def work():
        for _ in range(30):
            result.save(path)
            if path.read_bytes() != whole:
                torn.append(path)

    threads = [ThreadPoolExecutor(1) for _ in range(4)]
    for each in [thread.submit(work) for thread in threads]:
        each.result()  # raises what it raised
    assert not torn and [file.name for file in tmp_path.iterdir()] == ["same.json"]
