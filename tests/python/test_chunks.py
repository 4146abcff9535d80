"""Points that come in chunks: any chunks give one result, which is that of all points at once."""

from __future__ import annotations

import json
import os
import pickle
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest
from command_line import run
from seeds import SEEDS

import symsurf
from symsurf import InvalidInput, InvalidParameter
from symsurf.batching import file_task
from symsurf.reading.in_chunks import chunks_of

COUNT = 50_000 * SEEDS


def body(count: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray, float]:
    """A tilted bumpy body with noise of 0.1 % of its diagonal, and the normal and offset of its mirror."""
    random = np.random.default_rng(seed)
    directions = random.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    x, y, z = directions.T
    radius = 1 + 0.2 * np.sin(3 * y + z) + 0.15 * x**2 * np.cos(4 * z)
    points = directions * radius[:, None] * (1, 1.5, 2) + 0.005 * random.normal(size=(count, 3))
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    centre = random.normal(size=3)
    return points @ axes.T + centre, axes[:, 0], float(axes[:, 0] @ centre)


@pytest.fixture(scope="module")
def points() -> np.ndarray:
    return body(COUNT)[0]


@pytest.fixture(scope="module")
def found(points) -> symsurf.Result:
    return symsurf.detect_chunks(points, "plane")


def same(result: symsurf.Result, other: symsurf.Result) -> bool:
    return (
        result.mirror == other.mirror
        and result.score == other.score
        and result.statistics == other.statistics
        and np.array_equal(result.points, other.points)
    )


def test_the_mirror_is_that_of_all_points(points, found):
    _, normal, offset = body(COUNT)
    tilt = np.degrees(np.arccos(min(1, abs(found.mirror.normal @ normal))))
    side = np.sign(found.mirror.normal @ normal)
    middle = points.mean(axis=0)
    shift = found.mirror.signed_distance(middle[None])[0] * side - (normal @ middle - offset)
    assert tilt < 0.05
    assert abs(shift) < 0.0002 * np.linalg.norm(np.ptp(points, axis=0))
    assert found.verdict == "found"
    assert found.statistics["summarized_points"] == COUNT


def test_any_chunks_in_any_order_give_the_same(points, found, rng):
    shuffled = rng.permutation(points)
    cuts = np.sort(rng.integers(0, COUNT, 40))
    ways = [
        np.array_split(points, 7),
        np.split(shuffled, cuts),
        lambda: (chunk for chunk in np.array_split(shuffled, 3)),
        (chunk for chunk in np.array_split(points[::-1], 9)),
        [points[:5].tolist(), [], points[5:]],
        sum_of(np.array_split(shuffled, 5)),
    ]
    assert all(same(symsurf.detect_chunks(way, "plane", threads=1), found) for way in ways)


def sum_of(chunks: list[np.ndarray]) -> symsurf.PointSummary:
    """Of summaries that were in other processes, the last first."""
    whole = symsurf.PointSummary()
    for chunk in reversed(chunks):
        whole.add(pickle.loads(pickle.dumps(symsurf.summarize(chunk))))
    return whole


def test_a_chunk_may_lie_where_the_last_one_lay(points, found):
    def chunks():
        buffer = np.empty((COUNT // 8, 3))
        for part in np.split(points, 8):
            buffer[:] = part
            yield buffer
        buffer[:] = np.nan

    assert same(symsurf.detect_chunks(chunks, "plane"), found)


def test_points_that_are_not_finite_are_counted(points, found):
    chunks = [points[:1000], np.full((7, 3), np.nan), points[1000:]]
    with pytest.warns(symsurf.InputWarning, match="7 points are not finite"):
        result = symsurf.detect_chunks(chunks, "plane")
    assert result.statistics.pop("nonfinite_points") == 7
    assert same(result, found)


def test_a_second_pass_pairs_the_points(points, found):
    matches = list(symsurf.match_chunks(np.array_split(points, 6), found))
    partners = np.concatenate([each.partners for each in matches])
    residuals = np.concatenate([each.residuals for each in matches])
    assert len(partners) == COUNT
    images = found.mirror.reflect(points)
    gaps = np.linalg.norm(found.points[partners] - images, axis=1)
    few = np.random.default_rng(1).integers(0, COUNT, 200)
    brute = [np.linalg.norm(found.points - images[i], axis=1).min() for i in few]
    np.testing.assert_allclose(gaps[few], brute)
    assert (
        0.5 < np.median(residuals) / (0.6745 * 0.005) < 1.5
    )  # the noise, without that of the means


def test_what_has_no_image_near_has_no_partner(points, found):
    chunks = [points, np.array([[100.0, 0, 0]])]
    result = symsurf.detect_chunks(chunks, "plane")
    last = list(symsurf.match_chunks(chunks, result))[-1]
    assert last.partners.tolist() == [-1]
    assert np.isnan(last.residuals).all()


def test_errors(points, found):
    with pytest.raises(InvalidInput, match=r"chunk 1 has shape \(5, 2\)"):
        symsurf.detect_chunks([points, points[:5, :2]])
    with pytest.raises(InvalidInput, match="chunk 0 holds no rows of three numbers"):
        symsurf.detect_chunks({"x": 1, "y": 2})
    with pytest.raises(InvalidInput, match="of type int"):
        symsurf.detect_chunks(7)
    with pytest.raises(InvalidInput, match="1e50"):
        symsurf.detect_chunks([points, [[1e51, 0, 0]]])
    with pytest.raises(InvalidInput):
        symsurf.detect_chunks([])
    with pytest.raises(InvalidParameter, match="cells is 5"):
        symsurf.detect_chunks(points, cells=5)
    with pytest.raises(InvalidParameter, match="no_such"):
        symsurf.detect_chunks(points, "no_such")
    with pytest.raises(InvalidInput, match="once alone"):
        list(symsurf.match_chunks(iter([points]), found))
    with pytest.raises(InvalidInput, match=f"{COUNT} points, and now {COUNT - 5}"):
        list(symsurf.match_chunks([points[5:]], found))
    moved = points.copy()
    moved[7, 1] += 1e-9
    with pytest.raises(InvalidInput, match="their points lie elsewhere"):
        list(symsurf.match_chunks([moved], found))


def test_progress_goes_up_and_cancels(points):
    fractions: list[float] = []
    symsurf.detect_chunks(np.tile(points, (8, 1)), "plane", progress=fractions.append)
    assert fractions == sorted(fractions)
    assert 0 < fractions[0] < fractions[-1] == 1
    with pytest.raises(symsurf.Cancelled):
        symsurf.detect_chunks(np.array_split(points, 5), progress=lambda _: False)


def las(path, points, system=b""):
    laspy = pytest.importorskip("laspy", reason="needs laspy: pip install laspy[lazrs]")
    header = laspy.LasHeader(point_format=0, version="1.2")
    header.scales, header.offsets = [1e-6] * 3, points.mean(axis=0)
    if system:
        header.vlrs.append(laspy.vlrs.VLR("LASF_Projection", 2112, record_data=system))
    scan = laspy.LasData(header)
    scan.xyz = points
    scan.write(path)


def e57(path, points):
    pye57 = pytest.importorskip("pye57", reason="needs pye57: pip install pye57")
    with pye57.E57(str(path), mode="w") as file:
        for scan in np.array_split(points, 3):
            file.write_scan_raw({f"cartesian{axis}": scan[:, k] for k, axis in enumerate("XYZ")})


def pieces(path, points):
    pyvista = pytest.importorskip("pyvista")
    from vtkmodules.vtkCommonDataModel import vtkPartitionedDataSet
    from vtkmodules.vtkIOHDF import vtkHDFWriter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    parts = np.array_split(points, 3)
    if path.suffix == ".vtkhdf":
        data, writer = vtkPartitionedDataSet(), vtkHDFWriter()
        for number, part in enumerate(parts):
            data.SetPartition(number, pyvista.PolyData(part))
        writer.SetFileName(str(path))
        writer.SetInputData(data)
        assert writer.Write()
        return
    for number, part in enumerate(parts):
        writer = vtkXMLPolyDataWriter()
        writer.SetFileName(str(path.with_name(f"{path.stem}_{number}.vtp")))
        writer.SetInputData(pyvista.PolyData(part))
        assert writer.Write()
    listed = "".join(f'<Piece Source="{path.stem}_{number}.vtp"/>' for number in range(3))
    path.write_text(
        f'<VTKFile type="PPolyData" version="0.1"><PPolyData GhostLevel="0"><PPoints>'
        f'<PDataArray type="Float64" Name="Points" NumberOfComponents="3"/></PPoints>{listed}'
        "</PPolyData></VTKFile>"
    )


def ply(path, points):
    rows = np.zeros(len(points), [("red", "u1"), ("x", ">f8"), ("y", ">f8"), ("z", ">f8")])
    for axis, column in zip("xyz", points.T):
        rows[axis] = column
    header = (
        f"ply\nformat binary_big_endian 1.0\ncomment end of\nelement vertex {len(points)}\n"
        "property uchar red\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 0\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(header.encode() + rows.tobytes())


WRITERS = {
    "a.npy": np.save,
    "a.las": las,
    "a.laz": las,
    "a.copc.laz": las,
    "a.ply": ply,
    "a.e57": e57,
    "a.pvtp": pieces,
    "a.vtkhdf": pieces,
}


@pytest.mark.parametrize("name", WRITERS)
def test_files_are_read_in_chunks(name, tmp_path, points):
    path, some = tmp_path / name, points[:5000]
    WRITERS[name](path, some)
    file = chunks_of(path)
    assert file.count in (5000, None)
    for _ in range(2):
        np.testing.assert_allclose(np.concatenate(list(file.start())), some, atol=1e-5)
    result = symsurf.detect_chunks(path, "plane")
    assert result.statistics["summarized_points"] == 5000
    twice = symsurf.detect_chunks([path, path], "plane")
    assert twice.statistics["summarized_points"] == 10000
    assert np.array_equal(result.points, twice.points) or name == "a.e57"


def test_files_that_cannot_be_read_in_chunks(tmp_path, points):
    np.save(tmp_path / "flat.npy", points[:, :2])
    (tmp_path / "text.ply").write_text("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n")
    (tmp_path / "cut.ply").write_bytes(b"ply\nformat binary_little_endian 1.0\nelement vertex 9\n"
                                       b"property float x\nproperty float y\nproperty float z\nend_header\n123")  # fmt: skip
    (tmp_path / "a.pvtp").write_text("no XML")
    for name, text in {
        "flat.npy": r"allowed are numbers, \(n, 3\)",
        "text.ply": "the format is ascii",
        "cut.ply": "truncated",
        "a.obj": "can be read whole",
        "a.pvtp": "broken PVTP",
        "gone.las": "gone.las",
    }.items():
        with pytest.raises(InvalidInput, match=text) as error:
            symsurf.detect_chunks(tmp_path / name)
        assert name in str(error.value)
    las(tmp_path / "feet.las", points[:100], b'PROJCS["a", UNIT["foot", 0.3048]]')
    las(tmp_path / "metres.las", points[:100], b'PROJCS["a", UNIT["metre", 1]]')
    with pytest.raises(InvalidInput, match="different coordinate reference systems"):
        symsurf.detect_chunks([tmp_path / "feet.las", tmp_path / "metres.las"])


def test_a_file_on_the_command_line(points, found, tmp_path, monkeypatch):
    np.save(tmp_path / "scan.npy", points)
    monkeypatch.chdir(tmp_path)
    formats = "summary.json,matches.npy"
    done = run("detect", "scan.npy", "--in-chunks", "--json", "--method", "plane",
               "--output", "out", "--formats", formats)  # fmt: skip
    record = json.loads(done.stdout)
    assert record["score"] == found.score
    assert record["points"] == len(found.points)
    assert f"{COUNT} points thinned" in done.stderr
    matches = np.load(tmp_path / "out" / "scan.matches.npy", mmap_mode="r")
    expected = next(symsurf.match_chunks([points], found))
    np.testing.assert_array_equal(matches["partner"], expected.partners)
    np.testing.assert_array_equal(matches["residual"], expected.residuals)
    refused = run("detect", "scan.npy", "--in-chunks", "--downsample", "3")
    assert refused.returncode
    assert "in_chunks is given beside downsample" in refused.stderr


def test_large_files_are_read_in_chunks_by_themselves(points, found, tmp_path, monkeypatch):
    monkeypatch.setattr(file_task, "LARGE", COUNT - 1)
    np.save(tmp_path / "scan.npy", points)
    record = file_task.perform(file_task.FileTask(tmp_path / "scan.npy", method="plane"))
    assert record["score"] == found.score
    assert "in chunks" in record["notices"][0]


def test_dask_whichever_worker_dies(points, found):
    array = pytest.importorskip("dask.array", reason="needs Dask: pip install distributed")
    distributed = pytest.importorskip("distributed", reason="needs Dask: pip install distributed")
    blocks = array.from_array(points, chunks=(COUNT // 44, 2))
    assert same(symsurf.detect_chunks(blocks, "plane"), found)
    assert same(symsurf.detect(blocks, "plane"), found)
    matches = np.concatenate([each.residuals for each in symsurf.match_chunks(blocks, found)])
    assert np.array_equal(matches, next(symsurf.match_chunks([points], found)).residuals)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as all_,
        distributed.Client(all_) as client,
    ):
        workers = client.run(os.getpid)

        def killing(block, block_info=None):
            if block_info[0]["chunk-location"][0] == 20 and os.getpid() == max(workers.values()):
                os.kill(os.getpid(), signal.SIGKILL)
            return block

        slowed = blocks.rechunk((COUNT // 44, 3)).map_blocks(killing, dtype=float)
        assert same(symsurf.detect_chunks(slowed, "plane"), found)
        os.kill(min(workers.values()), signal.SIGKILL)
        assert same(symsurf.detect_chunks(blocks, "plane"), found)


def test_processes_of_mpi(points, found, tmp_path):
    pytest.importorskip("mpi4py", reason="needs mpi4py: pip install mpi4py")
    if shutil.which("mpirun") is None:
        pytest.skip("no mpirun")
    np.save(tmp_path / "points.npy", points)
    program = tmp_path / "program.py"
    program.write_text(
        "import pickle, sys\n"
        "import numpy as np, symsurf\n"
        "from mpi4py import MPI\n"
        "world = MPI.COMM_WORLD\n"
        "own = np.load(sys.argv[1], mmap_mode='r')[world.rank :: world.size]\n"
        "found = symsurf.detect_chunks([own], 'plane', communicator=world)\n"
        "np.savez(f'{sys.argv[1]}.{world.rank}', points=found.points, score=found.score,\n"
        "         normal=found.mirror.normal, world=world.size)\n"
    )
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "3"]
    subprocess.run(
        [*mpirun, sys.executable, program, tmp_path / "points.npy"], check=True, timeout=120
    )
    bad = program.read_text().replace("[own]", "[own[:, :2] if world.rank == 1 else own]")
    program.write_text(bad)
    failed = subprocess.run(
        [*mpirun, sys.executable, program, tmp_path / "points.npy"],
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert failed.returncode
    assert failed.stderr.count("InvalidInput: chunk 0 has shape") >= 1
    for rank in range(3):
        theirs = np.load(tmp_path / f"points.npy.{rank}.npz")
        assert theirs["world"] == 3
        assert theirs["score"] == found.score
        assert np.array_equal(theirs["normal"], found.mirror.normal)
        assert np.array_equal(theirs["points"], found.points)
