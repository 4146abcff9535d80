"""Files that reach for more than they are: code beside them, other files, memory, the terminal."""

from __future__ import annotations

import base64
import csv
import gzip
import json
import os
import resource
import stat
import subprocess
import sys
import time
import zipfile
from pathlib import Path, PureWindowsPath

import numpy as np
import pytest
from command_line import run
from dialects import POINTS, data_sets
from symmetric_shapes import mirrored_surface

import symsurf
from symsurf.base import own_process
from symsurf.reading import location
from symsurf.reading.in_chunks import chunks_of
from symsurf.saving import csv_rows
from symsurf.saving.sole_writer import sole_writer

VTP = data_sets.xml(
    "PolyData",
    'NumberOfPoints="6" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0"',
    '<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">'
    f"{' '.join(map(str, POINTS.ravel()))}</DataArray></Points>",
)


def write(path: Path, content: bytes | str) -> Path:
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


# Code beside the data.


def modules() -> set[str]:
    """All that anything could import here."""
    installed = {
        each.name.partition(".")[0]
        for folder in sys.path
        if os.path.isdir(folder)
        for each in Path(folder).iterdir()
        if each.suffix in (".py", ".so") or (each / "__init__.py").exists()
    }
    return {name for name in installed | sys.stdlib_module_names if name.isidentifier()}


COMMANDS = [
    ["asymmetry", "scan.vtp", "--mirror", "mirror.json"],
    ["detect", "scan.vtp", "cloud.xyz", "--method", "plane", "--jobs", "2"],
    ["detect", "scan.pvtp", "--method", "plane", "--in-chunks"],
    ["detect", "mask.nrrd", "--method", "plane"],
]


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_no_module_comes_from_the_folder_of_the_data(words, tmp_path):
    nrrd = pytest.importorskip("nrrd")
    folder, bin_ = tmp_path / "data", tmp_path / "bin"
    folder.mkdir()
    bin_.mkdir()
    script = write(
        bin_ / "symsurf-here.py", "from symsurf.cli import main; raise SystemExit(main())"
    )
    write(folder / "scan.vtp", VTP)
    write(folder / "scan.pvtp", pieces("scan.vtp"))
    nrrd.write(str(folder / "mask.nrrd"), np.arange(60, dtype="u1").reshape(3, 4, 5) % 2)
    np.savetxt(folder / "cloud.xyz", mirrored_surface(200, 0)[0])
    write(folder / "mirror.json", '{"mirror": {"kind": "plane", "normal": [1, 0, 0], "offset": 0}}')
    names = modules()
    assert {"numpy", "pickle", "pyvista", "symsurf", "multiprocessing", "nrrd", "struct"} <= names
    for name in names:
        write(folder / f"{name}.py", f"open({str(tmp_path / 'ran')!r}, 'a').write('{name} ')\n")
    done = subprocess.run(
        [sys.executable, script, *words], cwd=folder, capture_output=True, text=True, check=False
    )
    assert not (tmp_path / "ran").exists(), (tmp_path / "ran").read_text()
    assert done.returncode == 0 and done.stdout.count("mirror") >= 1, done.stderr


# Other files.


def gltf(uri: str, count: int = 36) -> str:
    tree = {
        "asset": {"version": "2.0"},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5121, "count": count // 3, "type": "VEC3"}
        ],
        "bufferViews": [{"buffer": 0, "byteLength": count}],
        "buffers": [{"uri": uri, "byteLength": count}],
    }
    return json.dumps(tree)


def nhdr(name: str) -> str:
    return (
        f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 3 4\nencoding: raw\ndata file: {name}\n\n"
    )


def pieces(name: str) -> str:
    return (
        '<VTKFile type="PPolyData" version="0.1"><PPolyData GhostLevel="0"><PPoints>'
        '<PDataArray type="Float64" NumberOfComponents="3"/></PPoints>'
        f'<Piece Source="{name}"/></PPolyData></VTKFile>'
    )


def read_gltf(path: Path, **options) -> int:
    return len(symsurf.read(write(path.with_suffix(".gltf"), gltf(path.name)), **options).points)


def read_nrrd(path: Path, **options) -> int:
    pytest.importorskip("nrrd")
    file = write(path.with_suffix(".nrrd"), nhdr(path.name))
    return len(symsurf.read(file, threshold=64, **options).points)


READERS = {"gltf": gltf, "nrrd": nhdr, "pvtp": pieces}


def points_of(kind: str, folder: Path, name: str, **options) -> int:
    path = write(folder / f"file.{kind}", READERS[kind](name))
    if kind == "pvtp":
        pytest.importorskip("pyvista")
        found = symsurf.summarize(path, **options)
        return found.count
    if kind == "nrrd":
        pytest.importorskip("nrrd")
        options["threshold"] = 64
    return len(symsurf.read(path, **options).points)


@pytest.fixture
def outside(tmp_path) -> Path:
    """A folder beside "secret", which has a file that each format can read."""
    (tmp_path / "secret").mkdir()
    write(tmp_path / "secret" / "token", bytes(range(60, 96)))
    write(tmp_path / "secret" / "token.vtp", VTP)
    (tmp_path / "data" / "below").mkdir(parents=True)
    return tmp_path / "data"


def secret_of(kind: str, folder: Path) -> Path:
    return folder.parent / "secret" / ("token.vtp" if kind == "pvtp" else "token")


@pytest.mark.parametrize("kind", READERS)
def test_files_beside_and_below_are_read(kind, outside):
    secret = secret_of(kind, outside)
    for place in (outside / secret.name, outside / "below" / secret.name):
        place.write_bytes(secret.read_bytes())
        assert points_of(kind, outside, str(place.relative_to(outside))) > 0
        assert points_of(kind, outside, str(place)) > 0


@pytest.mark.parametrize("way", ["up", "absolute", "link", "folder link", "down and up"])
@pytest.mark.parametrize("kind", READERS)
def test_no_other_file_is_read_unless_that_is_asked_for(kind, way, outside):
    secret = secret_of(kind, outside)
    (outside / "link").symlink_to(secret)
    (outside / "elsewhere").symlink_to(secret.parent)
    name = {
        "up": f"../secret/{secret.name}",
        "absolute": str(secret),
        "link": "link",
        "folder link": f"elsewhere/{secret.name}",
        "down and up": f"below/../../secret/{secret.name}",
    }[way]
    with pytest.raises(symsurf.InvalidInput, match="neither beside nor below") as error:
        points_of(kind, outside, name)
    assert str(error.value).startswith(str(outside / f"file.{kind}"))
    assert points_of(kind, outside, name, external_files=True) > 0


@pytest.mark.parametrize("kind", READERS)
def test_what_is_no_file_is_not_opened(kind, outside):
    os.mkfifo(outside / "pipe")  # to open it would wait for ever
    (outside / "loop").symlink_to("loop")
    for name in ("pipe", "loop", "below", "none", "."):
        with pytest.raises(symsurf.InvalidInput, match="file"):
            points_of(kind, outside, name, external_files=True)
    with pytest.raises(symsurf.InvalidInput):
        points_of(kind, outside, "/proc/self/environ")


def test_pipes_are_no_chunks(tmp_path):
    for suffix in (".las", ".npy", ".ply", ".pvtp"):
        os.mkfifo(tmp_path / f"pipe{suffix}")
        with pytest.raises(symsurf.InvalidInput, match="this is not a file"):
            symsurf.detect_chunks(tmp_path / f"pipe{suffix}")


def test_links_of_vtkhdf_to_other_files(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    from vtkmodules.vtkCommonDataModel import vtkPartitionedDataSet
    from vtkmodules.vtkIOHDF import vtkHDFWriter

    data, writer = vtkPartitionedDataSet(), vtkHDFWriter()
    for number, part in enumerate(np.split(np.random.default_rng(0).normal(size=(300, 3)), 3)):
        data.SetPartition(number, pyvista.PolyData(part))
    writer.SetFileName(str(tmp_path / "parts.vtkhdf"))
    writer.SetUseExternalPartitions(True)
    writer.SetInputData(data)
    assert writer.Write() and len(list(tmp_path.iterdir())) == 4
    with pytest.raises(symsurf.InvalidInput, match="external_files=True"):
        symsurf.summarize(tmp_path / "parts.vtkhdf")
    assert symsurf.summarize(tmp_path / "parts.vtkhdf", external_files=True).count == 300


# Memory.


def many_items(path: Path, vertices: int, items: int) -> Path:
    points = '<vertex x="0" y="0" z="0"/>' * vertices
    faces = '<triangle v1="0" v2="1" v3="2"/>' * vertices
    mesh = f"<mesh><vertices>{points}</vertices><triangles>{faces}</triangles></mesh>"
    built = '<item objectid="1"/>' * items
    model = (
        '<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
        f'<object id="1">{mesh}</object></resources><build>'
        f"{built}</build></model>"
    )
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", model)
    return path


def many_nodes(
    path: Path, points: int, nodes: int, primitives: int = 1, places: int = 50, **accessor
) -> Path:
    data = base64.b64encode(bytes(12 * points)).decode()
    attributes = [{"attributes": {"POSITION": i % places}, "mode": 0} for i in range(primitives)]
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": list(range(nodes))}],
        "nodes": [{"mesh": 0}] * nodes,
        "meshes": [{"primitives": attributes}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": points, "type": "VEC3"} | accessor
        ]
        * 50,
        "bufferViews": [{"buffer": 0, "byteLength": 12 * points}],
        "buffers": [{"uri": f"data:;base64,{data}", "byteLength": 12 * points}],
    }
    return write(path, json.dumps(tree))


_NONE = {
    "count": 1,
    "indices": {"bufferView": 0, "componentType": 5121},
    "values": {"bufferView": 0},
}
BOMBS = {
    "3MF of many items": lambda folder: many_items(folder / "a.3mf", 20_000, 4000),
    "3MF of more items": lambda folder: many_items(folder / "a.3mf", 3, 200_000),
    "glTF of many nodes": lambda folder: many_nodes(folder / "a.gltf", 20_000, 5000),
    "glTF of more nodes": lambda folder: many_nodes(folder / "a.gltf", 1, 3000, 1000),
    "glTF of primitives of one place": lambda folder: many_nodes(
        folder / "a.gltf", 1, 3000, 1000, places=1
    ),
    "glTF of sparse copies": lambda folder: many_nodes(
        folder / "a.gltf", 200_000, 50, 50, sparse=_NONE
    ),
    "glTF of a count": lambda folder: write(
        folder / "a.gltf", gltf("data:;base64," + base64.b64encode(bytes(36)).decode(), 3 * 10**10)
    ),
    "PCD of a count": lambda folder: write(
        folder / "a.pcd",
        "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nPOINTS 9999999999\nDATA ascii\n1 2 3\n",
    ),
    "PLY of a count": lambda folder: write(
        folder / "a.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\nproperty double x\n"
        "property double y\nproperty double z\nend_header\n123",
    ),
    "NRRD of sizes": lambda folder: write(
        folder / "a.nrrd",
        b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 40000 40000 40\nencoding: gzip\n\n"
        + gzip.compress(bytes(3 << 30 >> 4)) * 16,
    ),
}

LIMITED = """
import resource, sys, symsurf
resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
try:
    symsurf.read(sys.argv[1])
except symsurf.InvalidInput as error:
    print(error)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10)
"""


@pytest.mark.parametrize("name", BOMBS)
def test_what_a_file_makes_of_itself_is_counted_before_it_is_made(name, tmp_path):
    if name.startswith("NRRD"):
        pytest.importorskip("nrrd")
    path = BOMBS[name](tmp_path)
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, path], capture_output=True, text=True, check=True
    )
    error, megabytes = done.stdout.splitlines()
    assert error.startswith(f"{path}: ")
    assert any(why in error for why in ("it holds more than", "parts", "truncated", "memory"))
    assert int(megabytes) < 700


def test_many_honest_copies_are_read(tmp_path):
    shape = symsurf.read(many_items(tmp_path / "a.3mf", 2000, 1000))
    assert len(shape.points) == len(shape.faces) == 2_000_000
    assert len(symsurf.read(many_nodes(tmp_path / "a.gltf", 2000, 1000)).points) == 2_000_000


def test_a_file_that_many_buffers_name_is_read_once(tmp_path):
    count = 3000
    tree = {
        "asset": {"version": "2.0"},
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": i}, "mode": 0} for i in range(count)]}
        ],
        "accessors": [
            {"bufferView": i, "componentType": 5121, "count": 1, "type": "VEC3"}
            for i in range(count)
        ],
        "bufferViews": [{"buffer": i, "byteLength": 3} for i in range(count)],
        "buffers": [{"uri": "a.gltf", "byteLength": 3}] * count,
        "extras": "a" * (1 << 20),
    }
    path = write(tmp_path / "a.gltf", json.dumps(tree))
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, path], capture_output=True, text=True, check=True
    )
    assert int(done.stdout) < 800
    assert len(symsurf.read(path).points) == count


def test_standard_input_that_does_not_end():
    code = "from symsurf.cli import main; raise SystemExit(main())"
    limited = f"import resource; resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30)); {code}"
    with open("/dev/zero", "rb") as zeros:
        done = subprocess.run(
            [sys.executable, "-c", limited, "detect", "-", "--input-format", "ply"],
            stdin=zeros,
            capture_output=True,
            text=True,
            check=False,
        )
    assert done.returncode and done.stderr.startswith("symsurf: standard input: it holds more than")
    assert done.stderr.count("\n") == 1


# Time.


def one_buffer(path: Path, size: int, primitives: int) -> Path:
    """Many primitives of one large buffer."""
    data = base64.b64encode(bytes(size)).decode()
    tree = {
        "asset": {"version": "2.0"},
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": i}, "mode": 0} for i in range(primitives)]}
        ],
        "accessors": [{"bufferView": 0, "componentType": 5121, "count": 1, "type": "VEC3"}]
        * primitives,
        "bufferViews": [{"buffer": 0, "byteLength": size - 1}],
        "buffers": [{"uri": f"data:;base64,{data}", "byteLength": size}],
    }
    return write(path, json.dumps(tree))


def commented_faces(path: Path, length: int) -> Path:
    """A tetrahedron whose faces have comments of one long word."""
    faces = [f"f {face} # {'a' * length}" for face in ("1 2 3", "1 3 4", "1 4 2", "2 4 3")]
    return write(path, "\n".join(["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1", *faces, ""]))


SLOW = {
    "TPS of spaces": (
        lambda folder: write(folder / "a.tps", f"LM3=1\n1 2 3\nID=a{' ' * 1_000_000}b\n"),
        "symsurf.read_landmarks(path)",
    ),
    "glTF of one buffer": (
        lambda folder: one_buffer(folder / "a.gltf", 8 << 20, 60_000),
        "symsurf.read(path)",
    ),
    "OBJ of long words": (
        lambda folder: commented_faces(folder / "a.obj", 300_000),
        "assert main(['complete', path, '--mirror', 'm.json', '--output', 'made']) == 0",
    ),
}

IN_TIME = """
import resource, sys, symsurf
from symsurf.cli import main
resource.setrlimit(resource.RLIMIT_CPU, (20, 20))
path = sys.argv[1]
"""


@pytest.mark.parametrize("name", SLOW)
def test_time_grows_as_the_file_does(name, tmp_path):
    make, call = SLOW[name]
    path = make(tmp_path)
    write(tmp_path / "m.json", '{"mirror": {"kind": "plane", "normal": [1, 0, 0], "offset": 0.2}}')
    done = subprocess.run(
        [sys.executable, "-c", IN_TIME + call, path], cwd=tmp_path, capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr


# Processes and descriptors.


def test_a_fork_beside_a_reader(tmp_path):
    """The child has processes of its own, and lets go of its parent's."""
    code = """
import os, signal, sys, threading, time, symsurf
stop = []
def read():
    while not stop:
        symsurf.read(sys.argv[1])
symsurf.read(sys.argv[1])
thread = threading.Thread(target=read)
thread.start()
for _ in range(3):
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        symsurf.read(sys.argv[1])
        os._exit(0)
    print(os.waitpid(child, 0)[1])
stop.append(1)
thread.join()
"""
    pytest.importorskip("pyvista")
    path = write(tmp_path / "scan.vtp", VTP)
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", code, path],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == "0\n" * 3 and done.stderr == ""


def test_many_descriptors(tmp_path):
    pytest.importorskip("pyvista")
    path = write(tmp_path / "scan.vtp", VTP)
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    if before[1] < 1300:
        pytest.skip("no more than 1024 descriptors are allowed here")
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(before[0], 1300), before[1]))
    held = [os.open(os.devnull, os.O_RDONLY) for _ in range(1100)]
    own_process.COMMON.forget()  # so that the next is begun beyond them
    try:
        assert len(symsurf.read(path).points) == 6
    finally:
        for descriptor in held:
            os.close(descriptor)
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


# Chunks.


def test_a_chunk_reader_that_dies_costs_its_file_alone(tmp_path):
    laspy = pytest.importorskip("laspy")
    scan = laspy.LasData(laspy.LasHeader(point_format=3, version="1.2"))
    scan.x, scan.y, scan.z = np.random.default_rng(0).normal(size=(3, 2000))
    scan.write(str(tmp_path / "good.laz"))
    content = bytearray((tmp_path / "good.laz").read_bytes())
    at = content.index(b"laszip encoded") + 52 + 12  # the number of points of a chunk
    content[at : at + 4] = b"\xfe\xff\xff\x7f"
    write(tmp_path / "bad.laz", content)
    write(tmp_path / "half.laz", content[: len(content) // 2])
    rows = list(
        symsurf.batch(
            [tmp_path / f"{name}.laz" for name in ("bad", "half", "good")], method="plane"
        )
    )
    assert [bool(row["error"]) for row in rows][1:] == [True, False]
    for name in ("bad", "half"):
        try:
            assert chunks_of(tmp_path / f"{name}.laz").count == 2000
            symsurf.detect_chunks(tmp_path / f"{name}.laz", "plane")
        except symsurf.InvalidInput as error:
            assert str(error).startswith(str(tmp_path / f"{name}.laz"))


DAMAGED_CHUNKS = {
    "empty.npy": b"",
    "archive.npy": b"PK\3\4" + bytes(60),
    "pickled.npy": b"\x93NUMPY\1\0\x46\0{'descr': '|O', 'fortran_order': False, 'shape': (3, 3), }" + b" " * 14 + b"\n",
    "word.ply": b"ply\nformat\nelement vertex 1\nproperty float x\nend_header\n",
    "byte.ply": b"ply\nformat \xff 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    b"end_header\n" + bytes(12),
    "count.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex\nend_header\n",
    "kind.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list\nend_header\n",
    "text.las": b"LASF" + b"\xff" * 400,
    "text.laz": b"LASF" + b"\0" * 400,
    "text.pvtp": b"<VTKFile type='PPolyData'>",
    "other.pvtp": b"<VTKFile type='PPolyData'><PPolyData><Piece Source='text.las'/></PPolyData></VTKFile>",
    "text.vtkhdf": b"\x89HDF\r\n\x1a\n" + bytes(300),
    "text.e57": b"ASTM-E57" + bytes(300),
}  # fmt: skip


@pytest.mark.parametrize("name", DAMAGED_CHUNKS)
def test_damaged_chunks_are_an_error_of_the_file(name, tmp_path, capfd):
    pytest.importorskip({".e57": "pye57", ".laz": "laspy"}.get(Path(name).suffix, "numpy"))
    path = write(tmp_path / name, DAMAGED_CHUNKS[name])
    with pytest.raises(symsurf.InvalidInput) as error:
        symsurf.detect_chunks(path, "plane")
    assert str(path) in str(error.value) and "\n" not in str(error.value)
    assert capfd.readouterr().err == ""


# What is written.


def test_no_control_character_reaches_the_terminal(tmp_path):
    escape = "\x1b]0;owned\x07\x1b[2K\rsymsurf: all is well\x9b31m\u202e"
    points = mirrored_surface(300, 0)[0]
    names = [f"b{escape.replace('/', '')}.xyz", "line\nbreak.xyz"]
    for name in names:
        np.savetxt(tmp_path / name, points)
    required = json.dumps({"asset": {"version": "2.0"}, "extensionsRequired": [escape]})
    write(tmp_path / "a.gltf", required)
    write(tmp_path / "c.ply", f"ply\nformat {escape} 1.0\nend_header\n")
    write(tmp_path / "d.vtk", f"# vtk DataFile Version 3.0\nt\n{escape}\n")
    write(tmp_path / "e.tps", f"LM={escape}\n")
    files = sorted(os.listdir(tmp_path))
    for words in (
        ["detect", *files, "--method", "plane", "--table", "t.csv"],
        ["asymmetry", *names, "--method", "plane"],
        ["cohort", "e.tps", names[0]],
        ["damage", "noise", names[0], "--output", f"{escape}.xyz"],
        ["detect", "--", f"--{escape}"],
        ["detect", f"--{escape}"],
    ):
        done = run(*words, cwd=tmp_path)
        said = done.stdout + done.stderr
        assert said and not set("\x1b\x07\r\x9b\u202e") & set(said), words
    done = run("detect", names[1], "--method", "plane", cwd=tmp_path)
    assert done.stdout.startswith("line\\nbreak.xyz\n")


def test_errors_of_json_are_short_and_escaped(tmp_path):
    path = tmp_path / "a.json"
    for kind in ("\x1b]0;owned\x07", "a" * 100_000):
        write(path, json.dumps({"method": "plane", "mirror": {"kind": kind}, "score": 1}))
        with pytest.raises(symsurf.InvalidInput) as error:
            symsurf.Result.load(path)
        assert str(error.value).startswith(f"{path}: no result") and "\x1b" not in str(error.value)
        assert len(str(error.value)) < 2000
    path = write(tmp_path / "a.gltf", '{"asset": {"version": "' + "9" * 100_000 + '"}}')
    with pytest.raises(symsurf.InvalidInput, match="glTF's version") as error:
        symsurf.read(path)
    assert len(str(error.value)) < 2000


def test_a_lock_follows_no_link(tmp_path):
    np.savetxt(tmp_path / "a.xyz", mirrored_surface(100, 0)[0])
    (tmp_path / ".t.csv.lock").symlink_to(tmp_path / "elsewhere")
    done = run("detect", "a.xyz", "--method", "plane", "--table", "t.csv", cwd=tmp_path)
    assert done.returncode and "t.csv" in done.stderr
    assert not (tmp_path / "elsewhere").exists()


@pytest.mark.parametrize("name", ["a;=1+1.xyz", "a\t@x.xyz", "a;b.xyz", "=a;-b.xyz"])
def test_no_cell_behind_a_semicolon_is_a_formula(name, tmp_path):
    np.savetxt(tmp_path / name, mirrored_surface(100, 0)[0])
    words = ("detect", "--method", "plane", "--table", "t.csv", name)
    for more in ((), ("--resume",)):
        assert run(*words, *more, cwd=tmp_path).returncode == 0
        text = (tmp_path / "t.csv").read_text()
        assert not any(mark + sign in text for mark in ";\t" for sign in "=+-@")
    (row,) = csv.DictReader((tmp_path / "t.csv").open())
    assert csv_rows.text_of(row["file"]) == name


def test_names_that_lead_to_other_machines():
    path = PureWindowsPath("C:/data/scan.gltf")
    away = (
        "\\\\host\\share\\a.bin",
        "//host/share/a.bin",
        "D:/a.bin",
        "\\\\?\\UNC\\host\\share\\a",
    )
    for name in away:
        assert location.leads_away(path.parent / name, path), name
    for name in ("a.bin", "below/a.bin", "c:/data/a.bin", "/data/a.bin"):
        assert not location.leads_away(path.parent / name, path), name


@pytest.mark.parametrize("name", ["a" * 300, "b/" * 3000, "none.mtl"])
def test_a_library_of_materials_that_cannot_be_there(name, tmp_path):
    lines = [f"mtllib {name}", *(f"v {' '.join(map(str, point))}" for point in POINTS.tolist())]
    path = write(tmp_path / "a.obj", "\n".join([*lines, "f 1 2 3", ""]))
    write(tmp_path / "m.json", '{"mirror": {"kind": "plane", "normal": [1, 0, 0], "offset": 0.2}}')
    done = run("align", path.name, "--mirror", "m.json", "--output", "made", cwd=tmp_path)
    assert done.returncode == 0 and "is not beside the file" in done.stderr
    assert (tmp_path / "made/a.obj").read_text().startswith(f"mtllib {name}\n")


def test_a_file_keeps_its_mode(tmp_path):
    path = tmp_path / "private.json"
    result = symsurf.match(mirrored_surface(100, 0)[0], symsurf.Plane((1, 0, 0), 0))
    for mode in (0o600, 0o640, 0o666):
        path.touch()
        path.chmod(mode)
        result.save(path)
        assert stat.S_IMODE(path.stat().st_mode) == mode and path.stat().st_size
    if os.geteuid() == 0:  # who may give files away
        os.chown(path, 65534, 65534)
        result.save(path)
        assert path.stat().st_uid == path.stat().st_gid == 65534


def test_two_runs_on_one_table(tmp_path):
    np.savetxt(tmp_path / "a.xyz", mirrored_surface(200, 0)[0])
    words = ("detect", "a.xyz", "--method", "plane", "--table", "t.csv")
    with sole_writer(tmp_path / "t.csv"):
        done = run(*words, cwd=tmp_path)
        assert done.returncode == 2 and "is being written by another run" in done.stderr
        assert run(*words[:-1], "u.csv", cwd=tmp_path).returncode == 0
    assert not (tmp_path / "t.csv").exists()
    assert run(*words, cwd=tmp_path).returncode == 0
    assert {path.name for path in tmp_path.iterdir()} == {"a.xyz", "t.csv", "u.csv"}
    # One that began at the same time and has ended.
    soon = time.time() + 60
    os.utime(tmp_path / "t.csv", (soon, soon))
    done = run(*words, cwd=tmp_path)
    assert done.returncode == 2 and "written by another run since this one began" in done.stderr
    assert run(*words, "--resume", cwd=tmp_path).returncode == 0


def test_a_run_that_was_killed_holds_no_table(tmp_path):
    code = "import sys, time; from pathlib import Path; from symsurf.saving.sole_writer import sole_writer\n"
    code += "with sole_writer(Path(sys.argv[1])): print('held', flush=True); time.sleep(600)"
    with subprocess.Popen(
        [sys.executable, "-c", code, tmp_path / "t.csv"], stdout=subprocess.PIPE
    ) as process:
        assert process.stdout.readline() == b"held\n"
        with pytest.raises(symsurf.InvalidParameter), sole_writer(tmp_path / "t.csv"):
            pass
        process.kill()
    with sole_writer(tmp_path / "t.csv"):
        pass
    assert not list(tmp_path.iterdir())


def test_damaged_landmarks_that_are_packed(tmp_path):
    rows = "".join(f"{i} {i * i} {i % 7}\n" for i in range(40))
    packed = gzip.compress(f"LM3=40\n{rows}".encode())
    path = tmp_path / "a.tps.gz"
    for at in range(len(packed)):
        damaged = bytearray(packed)
        damaged[at] ^= 0x55
        write(path, damaged)
        try:
            assert len(symsurf.read_landmarks(path).points) == 40
        except symsurf.InvalidInput as error:
            assert str(error).startswith(f"{path}: ")


# What is no fault of the file.


def test_a_fault_of_the_system_is_not_called_a_broken_file(tmp_path, monkeypatch):
    from symsurf.reading import gltf as reader

    path = write(tmp_path / "a.gltf", gltf("data:;base64," + base64.b64encode(bytes(36)).decode()))
    assert len(symsurf.read(path).points) == 12
    monkeypatch.delattr(reader.json, "loads")
    with pytest.raises(AttributeError, match="loads"):
        symsurf.read(path)
