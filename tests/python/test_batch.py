"""Many files: on processes, on executors of others, with broken ones among them."""

from __future__ import annotations

import csv
import io
import json
import os
import signal
import subprocess
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from itertools import islice

import numpy as np
import pytest
from command_line import run
from symmetric_shapes import difference, mirrored_surface

import symsurf
from symsurf.batching import file_task


@pytest.fixture
def files(tmp_path):
    """Symmetric clouds with their planes, and, third among them, a file that is none."""
    truths = {}
    for seed in range(6):
        path = tmp_path / f"shape{seed}.xyz"
        if seed == 2:
            path.write_text("not a cloud")
            truths[path] = None
            continue
        points, truth = mirrored_surface(600, seed)
        np.savetxt(path, points, fmt="%.17g")
        truths[path] = points, truth
    return truths


def told(rows):
    """The rows without what differs from run to run."""
    return [{name: value for name, value in row.items() if name != "seconds"} for row in rows]


def test_a_row_a_file_in_their_order(files):
    rows = list(symsurf.batch(files, method="plane", unit="mm"))
    assert [row["file"] for row in rows] == [str(path) for path in files]
    for row, known in zip(rows, files.values()):
        if known is None:
            assert "shape2.xyz" in row["error"] and "score" not in row
            continue
        points, truth = known
        assert row["error"] == "" and row["points"] == len(points) and row["unit"] == "mm"
        found = symsurf.Plane([row[f"normal_{axis}"] for axis in "xyz"], row["offset"])
        angle, gap = difference(found, truth, points)
        assert angle < 1e-6 and gap < 1e-9
        assert row["verdict"] == "found" and row["kind"] == "plane" and row["paired_share"] == 1
        assert row["max"] < 1e-9


def test_an_operation_with_its_statistics(files):
    good = [path for path, known in files.items() if known]
    rows = list(symsurf.batch(good, "asymmetry", method="plane", max_angle=40.0))
    for path, row in zip(good, rows):
        statistics = symsurf.asymmetry(
            path, symsurf.detect(path, "plane"), max_angle=40.0
        ).statistics
        for column, name in {"rms": "rms", "p50": "median", "p95": "p95", "max": "maximum"}.items():
            assert row[column] == statistics[name]
        assert row["paired_share"] == statistics["matched_share"]
        assert row["p99"] == statistics["p99"]
    aligned = list(symsurf.batch(good, "align", method="plane"))
    matrix = np.reshape(aligned[0]["matrix"], (4, 4))
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-12)


def test_any_number_of_processes_and_any_executor_give_the_same(files):
    expected = told(symsurf.batch(files, "asymmetry"))
    assert told(symsurf.batch(files, "asymmetry", jobs=2)) == expected
    with ThreadPoolExecutor(2) as threads:
        assert told(symsurf.batch(files, "asymmetry", threads)) == expected


def test_dask(files):
    distributed = pytest.importorskip("distributed", reason="needs Dask: pip install distributed")
    expected = told(symsurf.batch(files, "asymmetry"))
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as all_,
        distributed.Client(all_) as client,
        client.get_executor() as executor,
    ):
        assert told(symsurf.batch(files, "asymmetry", executor)) == expected
        with pytest.raises(symsurf.InvalidParameter, match="max_angle"):
            list(symsurf.batch(files, "asymmetry", executor, max_angle=1000))


@pytest.fixture
def cluster():
    """Dask's, of two processes that are replaced when they die, as on a cluster."""
    distributed = pytest.importorskip("distributed", reason="needs Dask: pip install distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as all_,
        distributed.Client(all_) as client,
    ):
        yield client


def test_a_worker_of_dask_that_is_killed_costs_no_file(files, cluster):
    paths = list(files) * 10
    expected = told(symsurf.batch(paths))
    with cluster.get_executor() as executor:
        rows = symsurf.batch(paths, executor=executor)
        first = next(rows)
        os.kill(next(iter(cluster.run(os.getpid).values())), signal.SIGKILL)
        assert told([first, *rows]) == expected


class PoisonedCluster:
    """Dask's executor, and a file that kills each worker it comes to."""

    def __init__(self, executor):
        self._executor = executor

    def submit(self, work, task):
        return self._executor.submit(dies if task.file.stem == "shape3" else work, task)


def test_a_file_that_kills_workers_of_dask_costs_no_other(files, cluster):
    """Dask gives up all that it had sent to a worker whenever that dies, where it allows no failure."""
    paths = [path for path in files for _ in range(5 if path.stem != "shape3" else 1)]
    expected = told(symsurf.batch(paths))
    cluster.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 0))
    with cluster.get_executor() as executor:
        rows = told(symsurf.batch(paths, executor=PoisonedCluster(executor)))
    lost = next(row for row in rows if "shape3" in row["file"])
    assert "KilledWorker" in lost["error"]
    assert [row for row in rows if row is not lost] == [
        row for row in expected if "shape3" not in row["file"]
    ]


def children():
    """The processes that this one has begun."""
    words = ["ps", "-ww", "--ppid", str(os.getpid()), "-o", "pid=,args="]
    lines = subprocess.run(words, capture_output=True, text=True, check=False).stdout.splitlines()
    return [int(line.split()[0]) for line in lines if "serve()" in line]


def test_a_process_that_is_killed_costs_no_file(files):
    paths = list(files) * 4
    expected = told(symsurf.batch(paths))
    rows = symsurf.batch(paths, jobs=2)
    first = next(rows)
    assert len(children()) >= 2
    for process in children():
        os.kill(process, signal.SIGKILL)
    assert told([first, *rows]) == expected


def dies(task):
    os.kill(os.getpid(), signal.SIGKILL)


class Poisoned(ProcessPoolExecutor):
    """An executor of which one file kills the worker, and so all."""

    def submit(self, work, task):
        return super().submit(dies if task.file.stem == "shape3" else work, task)


class WorkerLost(Exception):
    """As a cluster says it of one file."""


class Losing(ThreadPoolExecutor):
    def submit(self, work, task):
        def lost(task):
            raise WorkerLost("three workers died")

        return super().submit(lost if task.file.stem == "shape3" else work, task)


def test_an_executor_that_breaks_costs_no_file(files):
    with Poisoned(2) as executor:
        assert told(symsurf.batch(files, executor=executor)) == told(symsurf.batch(files))


def test_a_file_that_an_executor_loses_has_a_row(files):
    expected = told(symsurf.batch(files))
    with Losing(2) as executor:
        rows = told(symsurf.batch(files, executor=executor))
    lost = next(row for row in rows if "shape3" in row["file"])
    assert "WorkerLost: three workers died" in lost["error"] and "shape3.xyz: " in lost["error"]
    assert [row for row in rows if row is not lost] == [
        row for row in expected if "shape3" not in row["file"]
    ]


def test_a_job_takes_no_more_processors_than_it_was_given(tmp_path):
    """Of one thread, all processor time is that of the calling one, however busy the machine is."""
    np.savetxt(tmp_path / "large.xyz", mirrored_surface(40000, 0)[0])
    by_others = []
    for threads in (1, 2):
        all_, own = time.process_time(), time.thread_time()
        list(symsurf.batch([tmp_path / "large.xyz"], "asymmetry", method="plane", threads=threads))
        all_, own = time.process_time() - all_, time.thread_time() - own
        by_others.append((all_ - own) / all_)
    assert by_others[0] < 0.02 and by_others[1] > 0.1


def test_what_is_left_is_dropped_when_the_caller_has_enough(files):
    rows = symsurf.batch(list(files) * 1000, jobs=2)
    assert len(list(islice(rows, 2))) == 2
    before = len(children())
    del rows  # returns without the other 5998
    assert len(children()) == before - 2


def test_output_in_the_format_of_the_file(files, tmp_path):
    good = [path for path, known in files.items() if known]
    folder = tmp_path / "made"
    list(symsurf.batch(good, "align", jobs=2, output=folder))
    assert {path.name for path in folder.iterdir()} == {path.name for path in good}
    for path in good:
        made = symsurf.read(folder / path.name).points
        np.testing.assert_array_equal(made, symsurf.align(path).shape.points)


@pytest.mark.parametrize("operation", ["detect", "align"])
def test_what_nobody_foresaw_of_one_file_is_in_its_row(operation, files, tmp_path, monkeypatch):
    first, second = [path for path, known in files.items() if known][:2]
    writer = "save_shape" if operation == "align" else "write_whole"
    write = getattr(file_task, writer)

    def fails_once(*given):
        monkeypatch.setattr(file_task, writer, write)
        raise KeyError("no such thing")

    monkeypatch.setattr(file_task, writer, fails_once)
    rows = list(symsurf.batch([first, second], operation, method="plane", output=tmp_path / "made"))
    assert rows[0]["error"] == f"{first}: it cannot be written (KeyError: 'no such thing')"
    assert rows[1]["error"] == "" and len(list((tmp_path / "made").iterdir())) == 1


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"operation": "fold"}, "operation is 'fold'; allowed are detect, asymmetry"),
        ({"jobs": 0}, "jobs is 0"),
        ({"jobs": "two"}, "jobs is 'two'"),
        ({"jobs": 2.0}, "jobs is 2.0"),
        ({"jobs": True}, "jobs is True"),
        ({"method": "magic"}, "magic"),
        ({"speed": 1}, "speed"),
        ({"jobs": 2, "threads": -1}, "threads is -1"),
        ({"operation": "align", "axis": "w"}, "axis is w"),
    ],
)
def test_bad_parameters_are_one_error(files, arguments, says):
    with pytest.raises(symsurf.InvalidParameter, match=says):
        list(symsurf.batch(files, **arguments))


def test_what_is_wrong_is_raised_before_the_work(files, tmp_path):
    with ThreadPoolExecutor() as executor, pytest.raises(symsurf.InvalidParameter, match="jobs"):
        symsurf.batch(files, executor=executor, jobs=2)
    twin = tmp_path / "other" / next(iter(files)).name
    with pytest.raises(symsurf.InvalidParameter, match="would both be written as shape0"):
        symsurf.batch([*files, twin], output=tmp_path / "made")
    assert not (tmp_path / "made").exists()


def test_no_files():
    assert list(symsurf.batch([])) == [] and list(symsurf.batch([], jobs=3)) == []


def rows_of(path):
    return list(csv.DictReader(io.StringIO(path.read_text(errors="surrogateescape"))))


def test_table_of_the_command_line(files, tmp_path):
    done = run("asymmetry", *files, "--jobs", "2", "--unit", "mm", "--table", tmp_path / "t.csv")
    assert done.returncode == 1
    assert done.stdout.count("  verdict             found") == 5
    assert done.stderr.count("\n") == 1 and "shape2.xyz" in done.stderr
    rows = rows_of(tmp_path / "t.csv")
    expected = list(symsurf.batch(files, "asymmetry", unit="mm"))
    assert len(rows) == len(expected)
    for row, values in zip(rows, expected):
        for name, value in values.items():
            if name != "seconds":
                assert row[name] == str(value)
        assert set(row) >= {"kind", "volume_index", "matrix", "signed_mean", "seconds", "version"}
        assert row["version"] == symsurf.__version__


def test_lengths_in_input_units(files, tmp_path):
    path = next(iter(files))
    diagonal = float(np.linalg.norm(np.ptp(symsurf.read(path).points, axis=0)))
    rows = [
        list(symsurf.batch([path], "asymmetry", max_distance=0.05)),
        list(symsurf.batch([path], "asymmetry", max_distance=0.05 * diagonal, absolute=True)),
    ]
    assert rows[0][0]["rms"] == rows[1][0]["rms"]
    words = ("--absolute", "--max-distance", 0.05 * diagonal, "--json")
    record = json.loads(run("asymmetry", path, *words).stdout)
    assert record["parameters"]["max_distance"] == pytest.approx(0.05, rel=1e-12)
    words = ("--method", "plane", "--absolute", "--pair-distance", 0.04 * diagonal, "--json")
    record = json.loads(run("detect", path, *words).stdout)
    assert record["parameters"]["pair_distance"] == pytest.approx(0.04, rel=1e-12)


def test_names_that_are_no_text(files, tmp_path):
    """Linux's names are bytes; those that are no UTF-8 stay what they are."""
    path = os.fsencode(tmp_path) + b"/shape\xff.xyz"
    os.rename(next(iter(files)), path)
    name = os.fsdecode(path)
    gone = name.replace("shape", "gone")
    done = run(
        "detect", name, gone, "--jobs", "2", "--table", tmp_path / "t.csv", "--output",
        tmp_path / "made", errors="surrogateescape",
    )  # fmt: skip
    assert done.returncode == 1 and name in done.stdout and "gone" in done.stderr
    assert [row["file"] for row in rows_of(tmp_path / "t.csv")] == [name, gone]
    assert os.listdir(os.fsencode(tmp_path / "made")) == [b"shape\xff.summary.json"]


@pytest.mark.parametrize("start", "=+-@")
def test_no_cell_of_the_table_is_a_formula(start, tmp_path):
    points, _ = mirrored_surface(300, 0)
    name = f"{start}HYPERLINK(1).xyz"
    np.savetxt(tmp_path / name, points)
    (tmp_path / f"{start}2.xyz").write_text("")
    words = (f"--unit={start}1", "--method", "plane", "--table", "t.csv")
    run("detect", "--jobs", "1", *words, "--", name, f"{start}2.xyz", cwd=tmp_path)
    rows = rows_of(tmp_path / "t.csv")
    assert [row["file"] for row in rows] == [f"'{name}", f"'{start}2.xyz"]
    for row in rows:
        for text in row.values():
            assert not text.startswith(("=", "+", "@"))
            assert not text.startswith("-") or float(text) < 0
    assert rows[0]["unit"] == f"'{start}1"


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--jobs", "0"], "jobs is 0"),
        (["--jobs", "many"], "jobs is 'many'"),
        (["--table", "table.txt"], "allowed is the suffix .csv"),
        (["--plot"], "plot is given without output"),
        (["--output", "made", "--formats", "txt", "--table", "t.csv/none.csv"], "t.csv"),
    ],
)
def test_bad_options_are_one_error(files, tmp_path, words, says):
    (tmp_path / "t.csv").write_text("in the way")
    done = run("detect", *files, *words, cwd=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.count(says) == 1 and "Traceback" not in done.stderr


def test_the_table_overwrites_no_input(tmp_path):
    points, _ = mirrored_surface(600, 0)
    np.savetxt(tmp_path / "cloud.csv", points, delimiter=",")
    before = (tmp_path / "cloud.csv").read_bytes()
    done = run("detect", "cloud.csv", "--table", "./cloud.csv", cwd=tmp_path)
    assert done.returncode == 2 and "is an input" in done.stderr
    assert (tmp_path / "cloud.csv").read_bytes() == before


def test_one_file_and_no_pairs(files):
    (row,) = symsurf.batch(str(min(files)), method="plane")
    assert row["error"] == "" and row["paired_share"] > 0.5
    (row,) = symsurf.batch(min(files), method="plane", pairs=False)
    assert row["error"] == "" and "paired_share" not in row
