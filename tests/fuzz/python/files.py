"""Damaged files, read whole and in chunks, and what has to hold of what comes of them."""

from __future__ import annotations

import gzip
import json
import os
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
from clouds import Random, one_of

import symsurf
from symsurf.reading.in_chunks import is_chunked

sys.path.insert(0, str(Path(__file__).parents[2]))
from dialects import FACES, POINTS, clouds, data_sets, images, scenes, texts

SECONDS = 20  # until a file has to be read or refused, on a processor of its own

_DIALECTS = {
    ".ply": texts.PLY,
    ".obj": texts.OBJ,
    ".off": texts.OFF,
    ".stl": texts.STL,
    ".csv": texts.TABLE,
    ".gltf": scenes.GLTF,
    ".3mf": scenes.THREE_MF,
    ".vtk": data_sets.VTK,
    ".las": clouds.LAS,
    ".pcd": clouds.PCD,
    ".nrrd": images.NRRD,
    ".nii": images.NIFTI,
}
_LANDMARKS = {
    ".tps": "LM3=3\n1 2 3\n4 5 6\n7 8 9\nID=a\nSCALE=0.5\n",
    ".pts": "Version 1.0\n2\na 1 2 3\nb 9999 9999 9999\n",
    ".fcsv": "# Markups fiducial file version = 4.10\n# CoordinateSystem = 0\n# columns = id,x,y,z,label\n"
    "a,1,2,3,left\nb,4,5,6,right\n",
    ".csv": "name;x;y;z\na;1,5;2;3\nb;4;5;6\n",
    ".mrk.json": json.dumps(
        {"markups": [{"coordinateSystem": "LPS", "controlPoints": [{"label": "a", "position": [1, 2, 3]}]}]}
    ),
}  # fmt: skip


class FileTooSlow(Exception):
    """It took longer than a file may."""


class Case:
    """One damaged file: ``run`` reads it and judges what comes of it."""

    faces = None

    def __init__(self, seed: int, tell: Callable[[str], None]) -> None:
        random = np.random.default_rng(seed)
        kinds = sorted(seeds())
        self.kind = self._suffix = kinds[seed % len(kinds)]
        contents = seeds()[self.kind]
        self.content = damaged(contents[random.integers(len(contents))], random)
        if random.integers(12) == 0 and self.kind not in (".result.json", ".pvtp"):
            self._suffix += ".gz"
            self.content = gzip.compress(self.content)
            if random.integers(2):
                self.content = damaged(self.content, random)
        self.points = np.frombuffer(self.content, np.uint8)  # what is shown of it
        self.random, self.tell = random, tell

    def run(self) -> bool:
        """Whether one reader reads it, not all refuse it. Raises whatever is a finding."""
        is_read = False
        self.tell(f"{self._suffix} of {len(self.content)} bytes")
        before = set(os.listdir(tempfile.gettempdir()))
        with tempfile.TemporaryDirectory(prefix="fuzzed-") as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            path = Path(folder) / f"shape{self._suffix}"
            (Path(folder) / "piece.vtp").write_bytes(_piece())
            path.write_bytes(self.content)
            for read in self._readers(path):
                began = time.monotonic()
                try:
                    read()
                    is_read = True
                except symsurf.InvalidParameter:
                    pass
                except symsurf.InvalidInput as error:
                    text = str(error)
                    is_named = text.startswith((f"{folder}/shape.", "a coordinate is "))
                    if not is_named or "\n" in text:
                        raise
                if time.monotonic() - began > SECONDS:
                    raise FileTooSlow(f"{time.monotonic() - began:.0f} s")
        left = set(os.listdir(tempfile.gettempdir())) - before
        assert not [name for name in left if name.startswith("symsurf-")], left
        return is_read

    def _readers(self, path: Path) -> list[Callable[[], object]]:
        if self.kind.startswith(".result"):
            return [lambda: symsurf.Result.load(path)]
        if self.kind.startswith(".landmarks"):
            path = path.rename(path.with_name(path.name.replace(".landmarks", "")))
            return [lambda: symsurf.read_landmark_sets(path)]
        options = {"threshold": 0.5} if self.random.integers(2) else {}
        is_image = self.kind in (".nrrd", ".nii", ".vti", ".vtk")
        whole = lambda: sound(symsurf.read(path, **(options if is_image else {})))
        chunks = lambda: symsurf.summarize(path)
        readers = [] if self.kind in (".pvtp", ".vtkhdf", ".e57", ".npy") else [whole]
        return [*readers, chunks] if is_chunked(path) else readers


def sound(shape: symsurf.Shape) -> None:
    assert len(shape.points) and shape.points.dtype == np.float64
    assert shape.faces is None or (
        len(shape.faces) and 0 <= shape.faces.min() <= shape.faces.max() < len(shape.points)
    )
    assert shape.polygons is None or len(shape.polygons) == len(shape.faces)


def damaged(content: bytes, random: Random) -> bytes:
    """Cut, with bytes or words changed, with pieces doubled, moved or of something else."""
    changed = bytearray(content)
    for _ in range(random.integers(1, 4)):
        size = max(1, len(changed))
        at = int(random.integers(size))
        # What a header says stands in front.
        at = int(at * random.random() ** 2) if random.integers(2) else at
        end = min(size, at + int(random.integers(1, 64)))
        kind = random.integers(8)
        if kind == 0:
            del changed[at:]
        elif kind == 1:
            changed[at : at + 1] = bytes([random.integers(256)])
        elif kind == 2:
            changed[at:end] = random.integers(256, size=end - at, dtype=np.uint8).tobytes()
        elif kind == 3:
            del changed[at:end]
        elif kind == 4:
            changed[at:at] = changed[at:end] * int(random.integers(1, 5))
        elif kind == 5:
            width = int(one_of((2, 4, 8), random))
            number = int(one_of((0, 1, 255, 2**15, 2**31 - 1, 2**32 - 1, 2**62, 2**64 - 1), random))
            changed[at : at + width] = (number % 2 ** (8 * width)).to_bytes(width, "little")
        elif kind == 6:
            words = (
                b"-1",
                b"99999999999",
                b"1e400",
                b"nan",
                b"",
                b"\0",
                b"2147483648",
                b"../x",
                b"\xff",
            )
            word = one_of(words, random)
            while at < len(changed) and not changed[at : at + 1].isdigit():
                at += 1
            end = at
            while end < len(changed) and changed[end : end + 1].isdigit():
                end += 1
            changed[at:end] = word
        else:
            other = one_of(tuple(seeds()), random)
            piece = seeds()[other][0]
            changed[at:end] = piece[: random.integers(1, 200)]
    return bytes(changed)


@cache
def seeds() -> dict[str, list[bytes]]:
    """Good files by their suffix."""
    found: dict[str, list[bytes]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for suffix, dialects in _DIALECTS.items():
            for content in dialects.values():
                own = suffix
                if isinstance(content, tuple):
                    own, content = content
                if callable(content):
                    path = Path(folder) / f"shape{own}"
                    content(path)
                    content = path.read_bytes()
                found.setdefault(own.removesuffix(".gz"), []).append(
                    gzip.decompress(content) if own.endswith(".gz") else content
                )
        _add_written(found, Path(folder))
    pieces = (
        b'<VTKFile type="PPolyData" version="0.1"><PPolyData GhostLevel="0"><PPoints>'
        b'<PDataArray type="Float64" NumberOfComponents="3"/></PPoints><Piece Source="piece.vtp"/>'
        b"</PPolyData></VTKFile>"
    )
    found[".pvtp"] = [pieces]
    for suffix, text in _LANDMARKS.items():
        found[f".landmarks{suffix}"] = [text.encode()]
    return found


def _add_written(found: dict[str, list[bytes]], folder: Path) -> None:
    """What libraries write, and symsurf."""
    import pyvista
    import trimesh
    from vtkmodules.vtkIOHDF import vtkHDFWriter

    points = np.random.default_rng(0).normal(size=(300, 3))
    np.save(folder / "a.npy", points)
    trimesh.Trimesh(POINTS, FACES, process=False).export(folder / "a.glb")
    mesh = pyvista.PolyData.from_regular_faces(POINTS, FACES)
    mesh.save(folder / "a.vtp")
    mesh.cast_to_unstructured_grid().save(folder / "a.vtu")
    image = pyvista.ImageData(dimensions=(4, 5, 6))
    image["mask"] = np.arange(120) % 2
    image.save(folder / "a.vti")
    writer = vtkHDFWriter()
    writer.SetFileName(str(folder / "a.vtkhdf"))
    writer.SetInputData(pyvista.PolyData(points))
    writer.Write()
    symsurf.match(points, symsurf.Plane((1, 0, 0), 0)).save(folder / "a.result.json")
    rows = np.zeros(50, [("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("i", "u1")])
    header = b"ply\nformat binary_little_endian 1.0\nelement vertex 50\nproperty double x\n"
    header += b"property double y\nproperty double z\nproperty uchar i\nend_header\n"
    (folder / "a.ply").write_bytes(header + rows.tobytes())
    try:
        import pye57

        with pye57.E57(str(folder / "a.e57"), mode="w") as file:
            file.write_scan_raw({f"cartesian{axis}": points[:, k] for k, axis in enumerate("XYZ")})
    except ImportError:
        pass
    for path in sorted(folder.glob("a.*")):
        found.setdefault("".join(path.suffixes), []).append(path.read_bytes())


@cache
def _piece() -> bytes:
    return seeds()[".vtp"][0]
