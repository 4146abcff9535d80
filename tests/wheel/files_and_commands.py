"""Reads a file of each format that needs no other package, packed and open too, and runs the command line,
with jobs and a table: on whatever system this Python is of."""

from __future__ import annotations

import gzip
import io
import os
import struct
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from dialects import clouds, scenes, texts

import symsurf
from symsurf.base import own_process
from symsurf.cli import main
from symsurf.reading.formats import FORMATS
from symsurf.saving.sole_writer import sole_writer


def packed(tree: bytes) -> bytes:
    """A scene of glTF as GLB."""
    tree += b" " * (-len(tree) % 4)
    return struct.pack("<4s4I", b"glTF", 2, 20 + len(tree), len(tree), 0x4E4F534A) + tree


CONTENTS = {
    ".ply": next(iter(texts.PLY.values())),
    ".obj": next(iter(texts.OBJ.values())),
    ".off": next(iter(texts.OFF.values())),
    ".stl": next(iter(texts.STL.values())),
    ".csv": b"x,y,z\n1,2,3\n4,5,6\n",
    ".txt": b"1 2 3\n4 5 6\n",
    ".xyz": b"1 2 3\n4 5 6\n",
    ".fcsv": b"# columns = id,x,y,z\na,1,2,3\nb,4,5,6\n",
    ".gltf": scenes.GLTF["embedded"],
    ".glb": packed(scenes.GLTF["embedded"]),
    ".3mf": next(each for each in scenes.THREE_MF.values() if isinstance(each, bytes)),
    ".las": next(each for each in clouds.LAS.values() if isinstance(each, bytes)),
    ".pcd": next(each for each in clouds.PCD.values() if isinstance(each, bytes)),
}  # fmt: skip


def read_all() -> None:
    for suffix, content in CONTENTS.items():
        path = Path(f"shape{suffix}")
        path.write_bytes(content)
        count = len(symsurf.read(path).points)
        assert count, suffix
        Path(f"{path}.gz").write_bytes(gzip.compress(content))
        assert len(symsurf.read(f"{path}.gz").points) == count, suffix
        assert len(symsurf.read(io.BytesIO(content), suffix[1:]).points) == count, suffix
        path.write_bytes(content[: len(content) // 2])
        try:
            symsurf.read(path)
        except symsurf.InvalidInput as error:
            assert str(error).startswith(f"{path}: "), error
    assert set(CONTENTS) == {suffix for suffix, each in FORMATS.items() if not each.packages}


def use_processes() -> None:
    assert own_process.call("os", "getpid") != os.getpid()
    try:
        own_process.call("os", "abort")
    except own_process.ProcessDied:
        assert own_process.call("math", "sqrt", 4.0) == 2
    assert list(own_process.stream("builtins", "iter", [1, 2])) == [1, 2]


def run_commands() -> None:
    random = np.random.default_rng(0)
    for number in range(3):
        half = random.normal(size=(100, 3))
        np.savetxt(f"cloud{number}.xyz", np.vstack([half, half * (-1, 1, 1)]))
    files = [f"cloud{number}.xyz" for number in range(3)]
    words = ["--method", "plane", "--jobs", "2", "--table", "table.csv", "--output", "made"]
    assert main(["detect", *files, *words]) == 0
    assert Path("table.csv").read_text().count("\n") == 4
    assert len(list(Path("made").iterdir())) == 3
    assert main(["align", *files, "none.xyz", "--method", "plane", "--output", "aligned"]) == 1
    assert len(symsurf.read("aligned/cloud0.xyz").points) == 200
    with sole_writer(Path("table.csv")):
        assert main(["detect", *files, *words]) == 2
    assert not [path for path in Path().iterdir() if path.suffix in (".partial", ".lock")]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        read_all()
        use_processes()
        run_commands()
        os.chdir(Path(folder).parent)
    print(f"{len(CONTENTS)} formats, processes and commands")
