"""Tables of many files: killed, resumed, in shards, merged."""

from __future__ import annotations

import csv
import io
import os
import pty
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from command_line import run, run_here
from symmetric_shapes import mirrored_surface

import symsurf
from symsurf.batching.file_task import FileTask
from symsurf.batching.growing_table import GrowingTable
from symsurf.batching.result_table import columns_of, read_table
from symsurf.cli.progress_bar import time_shown
from symsurf.saving.csv_rows import rows_bytes

PLANE = ("--method", "plane")


def write_clouds(folder, count):
    """Small ones, and among them one that is none."""
    folder.mkdir()
    random = np.random.default_rng(count)
    for number in range(count):
        half = random.uniform(0, 1, (random.integers(20, 50), 3))
        np.savetxt(folder / f"shape{number:04}.xyz", np.vstack([half, half * (-1, 1, 1)]))
    (folder / "shape0007.xyz").write_text("not a cloud")


@pytest.fixture
def clouds(tmp_path):
    write_clouds(tmp_path / "clouds", 60)
    return tmp_path / "clouds"


def content(path):
    """The lines of cells, names too, without what differs from run to run."""
    lines = list(csv.reader(io.StringIO(path.read_text(), newline="")))
    seconds = lines[0].index("seconds")
    return [line[:seconds] + line[seconds + 1 :] for line in lines]


def detect(folder, *words, killed_after=None):
    """Runs it; or kills it when its table has so many lines."""
    command = [sys.executable, "-m", "symsurf", "detect", folder, *PLANE, *words]
    process = subprocess.Popen([str(word) for word in command], stdout=-3, stderr=-3)
    if killed_after is not None:
        table = words[words.index("--table") + 1]
        while process.poll() is None and lines_of(table) < killed_after:
            time.sleep(0.001)
        process.kill()
    return process.wait(120)


def lines_of(table):
    return table.read_bytes().count(b"\n") if table.exists() else 0


@pytest.mark.parametrize("jobs", [1, 2])
def test_killed_three_times_and_resumed_it_is_the_table_of_one_run(jobs, clouds, tmp_path, rng):
    assert detect(clouds, "--table", tmp_path / "whole.csv") == 1
    expected = content(tmp_path / "whole.csv")
    assert len(expected) == 61
    table = tmp_path / "killed.csv"
    words = ("--jobs", jobs, "--resume", "--table", table)
    before = 0
    for _ in range(3):
        detect(clouds, *words, killed_after=before + rng.integers(2, 18))
        rows = read_table(table)
        assert before <= len(rows) + 1
        before = len(rows)
    assert detect(clouds, *words) == 1
    assert content(table) == expected


def test_shards_that_are_killed_resumed_and_merged(clouds, tmp_path, rng):
    detect(clouds, "--table", tmp_path / "whole.csv")
    shards = [tmp_path / f"shard{number}.csv" for number in range(1, 5)]
    for number, table in enumerate(shards, 1):
        words = ("--resume", "--table", table, "--shard", f"{number}/4")
        detect(clouds, *words, killed_after=rng.integers(2, 15))
        assert detect(clouds, *words) == (1 if number == 4 else 0)
    whole = tmp_path / "merged.csv"
    assert run("table", "merge", *reversed(shards), "--output", whole).returncode == 0
    assert content(whole) == content(tmp_path / "whole.csv")


def test_what_is_done_is_not_done_again(clouds, tmp_path):
    table = tmp_path / "t.csv"
    detect(clouds, "--table", table)
    before = table.read_bytes()
    for path in clouds.iterdir():
        path.write_text("another")
    assert detect(clouds, "--table", table, "--resume") == 1
    after = table.read_bytes()
    assert after.splitlines()[:8] == before.splitlines()[:8]
    assert after.count(b"\n") == 61 and b"shape0007" in after.splitlines()[8]


def test_files_that_failed_are_done_again_and_stay_in_their_row(clouds, tmp_path):
    table = tmp_path / "t.csv"
    detect(clouds, "--table", table)
    np.savetxt(clouds / "shape0007.xyz", mirrored_surface(100, 0)[0])
    assert detect(clouds, "--table", table, "--resume") == 0
    detect(clouds, "--table", tmp_path / "whole.csv")
    assert content(table) == content(tmp_path / "whole.csv")


def test_what_was_made_and_is_gone_is_made_again(clouds, tmp_path):
    made = tmp_path / "made"
    words = ("--table", tmp_path / "t.csv", "--output", made)
    detect(clouds, *words)
    gone, kept = made / "shape0003.summary.json", made / "shape0004.summary.json"
    gone.unlink()
    kept.write_text("as it was")
    detect(clouds, *words, "--resume")
    assert gone.exists() and kept.read_text() == "as it was"


def test_more_files_than_the_table_has(clouds, tmp_path):
    np.savetxt(tmp_path / "first.xyz", mirrored_surface(100, 0)[0])
    run_here("detect clouds --method plane --table t.csv", tmp_path)
    run_here("detect first.xyz clouds --method plane --table t.csv --resume", tmp_path)
    run_here("detect first.xyz clouds --method plane --table whole.csv", tmp_path)
    assert content(tmp_path / "t.csv") == content(tmp_path / "whole.csv")


# Names that a table quotes, of which one has lines.
NAMES = ("a,b.xyz", "two\nlines.xyz", 'quoted"\r.xyz', "=1+1.xyz", "last.xyz")


def rows_of(kinds):
    """Those of files with mirrors of these kinds, which have columns of their own."""
    numbers = {
        "plane": {"normal_x": -0.5, "offset": 1e-3},
        "sphere": {"centre_x": 2.0, "radius": 1.0},
    }
    return [
        {"file": name, "score": 1.0, "kind": kind, "p99": 0.1, "settings": "detect", "error": ""}
        | numbers.get(kind, {"error": "it failed"})
        for name, kind in zip(NAMES, kinds)
    ]


ROWS = rows_of(["sphere", "plane", "none", "plane", "sphere"])
TASKS = [FileTask(name) for name in NAMES]


def table_of(path, rows):
    table = GrowingTable(path, TASKS, [], resume=True)
    for index in rows:
        table.add(index, ROWS[index])
    return table


def test_files_may_end_in_any_order(tmp_path, rng):
    table_of(tmp_path / "t.csv", range(5)).finish()
    expected = (tmp_path / "t.csv").read_bytes()
    for _ in range(20):
        path = tmp_path / f"{rng.integers(2**60)}.csv"
        order = rng.permutation(5).tolist()
        table_of(path, order[:3])  # and ends there
        table_of(path, [index for index in order if index == 2 or index in order[3:]]).finish()
        assert path.read_bytes() == expected


def test_a_table_that_ends_anywhere_has_the_rows_before(tmp_path):
    path = tmp_path / "t.csv"
    table_of(path, range(5))
    whole = path.read_bytes()
    rows = read_table(path)
    assert [row["file"] for row in rows] == [*NAMES[:3], "'=1+1.xyz", "last.xyz"]
    ends = [len(rows_bytes(rows[:count], columns_of(rows))) for count in range(6)]
    for length in range(ends[0], len(whole) + 1):
        path.write_bytes(whole[:length])
        assert read_table(path) == rows[: sum(end <= length for end in ends) - 1]
        table_of(path, range(5)).finish()
        assert sorted(path.read_bytes()) == sorted(whole)


def test_rows_that_are_kept_are_those_that_were_written(tmp_path):
    table_of(tmp_path / "t.csv", range(5))
    kept = GrowingTable(tmp_path / "t.csv", TASKS, [], resume=True).rows
    good = {index: row for index, row in enumerate(ROWS) if not row["error"]}
    assert kept == {index: row | {"unit": ""} for index, row in good.items()}


FOREIGN = {
    "another": "name,value\na,1\n",
    "empty": "",
    "no table": "\x00\x01\xff",
    "no lines": "file",
}


@pytest.mark.parametrize("text", FOREIGN.values(), ids=FOREIGN)
def test_a_table_of_others_is_left_as_it_is(text, clouds, tmp_path):
    table = tmp_path / "t.csv"
    table.write_text(text)
    done = run("detect", clouds, *PLANE, "--table", table, "--resume")
    assert done.returncode == 2 and done.stdout == ""
    assert "t.csv: this is no table that symsurf has written" in done.stderr
    assert table.read_text() == text


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ("clouds --method plane --unit mm", 'now \'detect method="plane" unit="mm"'),
        ("clouds --method plane --sample-size 300", "sample_size=300"),
        ("clouds --method sphere", "was made with 'detect method=\"plane\"'"),
        ("clouds/shape0001.xyz --method plane", "files that are not given, such as clouds"),
    ],
)
def test_a_table_of_another_run_is_left_as_it_is(words, says, clouds, tmp_path):
    run_here("detect clouds --method plane --table t.csv", tmp_path)
    before = (tmp_path / "t.csv").read_bytes()
    done = run_here(f"detect {words} --table t.csv --resume", tmp_path)
    assert done.returncode == 2 and done.stdout == "" and says in done.stderr
    assert (tmp_path / "t.csv").read_bytes() == before


def test_the_number_of_jobs_and_threads_may_differ(clouds, tmp_path):
    run_here("detect clouds --method plane --table t.csv", tmp_path)
    before = content(tmp_path / "t.csv")
    line = "detect clouds --method plane --table t.csv --resume --threads 1 --jobs 2"
    done = run_here(line, tmp_path)
    assert done.returncode == 1 and done.stdout == ""
    assert "shape0007.xyz" in done.stderr and done.stderr.count("\n") == 1
    assert content(tmp_path / "t.csv") == before


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("detect clouds --resume", "resume is given without table"),
        (
            "detect clouds --shard 0/4",
            "shard is '0/4'; allowed is I/N, the I-th of N, with I from 1",
        ),
        ("detect clouds --shard 5/4", "shard is '5/4'"),
        ("asymmetry clouds --shard 1", "shard is '1'"),
        ("symmetries clouds --bop --shard 1/2", "shard is given beside bop"),
        ("detect clouds --shard 1/60 --table clouds/shape0005.csv", "is an input"),
        ("table merge a.csv b.csv --output a.csv", "a.csv would overwrite an input"),
        ("table merge a.csv b.csv --output a.txt", "allowed is the suffix .csv"),
        ("table merge none.csv --output c.csv", "No such file or directory: 'none.csv'"),
    ],
)
def test_bad_options_are_one_error(line, says, clouds, tmp_path):
    (clouds / "shape0005.xyz").rename(clouds / "shape0005.csv")
    done = run_here(line, tmp_path)
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1
    assert says in done.stderr


def test_more_shards_than_files(tmp_path):
    write_clouds(tmp_path / "clouds", 8)
    run_here("detect clouds --method plane --table whole.csv", tmp_path)
    tables = []
    for number in range(1, 11):
        tables.append(f"{number}.csv")
        words = f"--shard {number}/10 --table {number}.csv"
        run_here(f"detect clouds --method plane {words}", tmp_path)
    assert run_here(f"table merge {' '.join(tables)} --output m.csv", tmp_path).returncode == 0
    assert content(tmp_path / "m.csv") == content(tmp_path / "whole.csv")


@pytest.fixture
def shards(tmp_path):
    """Of 8 files, a, b and c, and tables that do not go with them."""
    write_clouds(tmp_path / "clouds", 8)
    runs = {
        "a": "detect clouds --method plane --shard 1/3",
        "b": "detect clouds --method plane --shard 2/3",
        "c": "detect clouds --method plane --shard 3/3",
        "whole": "detect clouds --method plane",
        "other": "align clouds --method plane --shard 2/3",
        "fewer": "detect clouds/shape0001.xyz clouds/shape0004.xyz --method plane --shard 2/2",
        "one": "detect clouds/shape0001.xyz --method plane",
    }
    for name, line in runs.items():
        run_here(f"{line} --table {name}.csv", tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        ("a.csv b.csv c.csv b.csv whole.csv", "is in a.csv and in whole.csv"),
        (
            "a.csv other.csv",
            "a.csv was made with 'detect method=\"plane\"', but other.csv with 'align",
        ),
        ("a.csv fewer.csv", "a.csv is of a run of 8 files, but fewer.csv of one of 2"),
        ("a.csv one.csv", "one.csv has no column position, but a.csv has"),
        ("whole.csv one.csv", "file clouds/shape0001.xyz is in whole.csv and in one.csv"),
        ("a.csv clouds/shape0001.xyz", "shape0001.xyz: this is no table that symsurf has written"),
    ],
)
def test_tables_that_do_not_go_together_are_an_error(tables, says, shards):
    done = run_here(f"table merge {tables} --output m.csv", shards)
    assert done.returncode == 2 and says in done.stderr
    assert not (shards / "m.csv").exists()


def test_a_shard_that_is_missing_is_told(shards):
    done = run_here("table merge c.csv a.csv --output m.csv", shards)
    assert done.returncode == 1 and done.stderr == "symsurf: m.csv: 3 of 8 files are missing\n"
    whole = content(shards / "whole.csv")
    assert content(shards / "m.csv") == [line for i, line in enumerate(whole) if i % 3 != 2]


def test_whole_tables_follow_each_other(tmp_path):
    for name in ("b", "a"):
        np.savetxt(tmp_path / f"{name}.xyz", mirrored_surface(100, 0)[0])
        run_here(f"detect {name}.xyz --method plane --table {name}.csv", tmp_path)
    run_here("detect b.xyz a.xyz --method plane --table whole.csv", tmp_path)
    assert run_here("table merge b.csv a.csv --output m.csv", tmp_path).returncode == 0
    assert content(tmp_path / "m.csv") == content(tmp_path / "whole.csv")


def test_a_report_is_resumed(tmp_path):
    pytest.importorskip("trame_vtk")
    write_clouds(tmp_path / "clouds", 8)
    line = "report clouds --method plane --output r.html --table t.csv"
    run_here(line, tmp_path)
    page = (tmp_path / "r.html").read_text()
    before = (tmp_path / "r_files" / "shape0002.html").stat().st_mtime_ns
    (tmp_path / "r_files" / "shape0001.html").unlink()
    assert run_here(f"{line} --resume", tmp_path).returncode == 1
    assert (tmp_path / "r.html").read_text() == page
    assert (tmp_path / "r_files" / "shape0001.html").exists()
    assert (tmp_path / "r_files" / "shape0002.html").stat().st_mtime_ns == before


def children_of(parent):
    found = subprocess.run(
        ["pgrep", "-P", str(parent)], capture_output=True, text=True, check=False
    )
    return [int(word) for word in found.stdout.split()]


def is_alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_no_process_outlives_one_that_is_killed(tmp_path):
    write_clouds(tmp_path / "clouds", 400)
    table = tmp_path / "t.csv"
    command = ["detect", tmp_path / "clouds", *PLANE, "--jobs", "2", "--table", table]
    process = subprocess.Popen(
        [sys.executable, "-m", "symsurf", *map(str, command)], stdout=-3, stderr=-3
    )
    while lines_of(table) < 5:
        time.sleep(0.01)
    workers = children_of(process.pid)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    ends = time.monotonic() + 20
    while any(map(is_alive, workers)) and time.monotonic() < ends:
        time.sleep(0.05)
    assert len(workers) >= 2 and not any(map(is_alive, workers))


def pieces_from(terminal):
    try:
        while piece := os.read(terminal, 1 << 16):
            yield piece
    except OSError:  # the other end is closed
        return


def test_a_terminal_is_told_how_many_files_are_done(clouds, tmp_path):
    ours, theirs = pty.openpty()
    words = ("detect", clouds, *PLANE, "--table", tmp_path / "t.csv")
    command = [sys.executable, "-m", "symsurf", *map(str, words)]
    with subprocess.Popen(command, stdout=-3, stderr=theirs):
        os.close(theirs)
        told = b"".join(pieces_from(ours)).decode()
    os.close(ours)
    assert "1 of 60 files" in told and "59 of 60 files" in told
    assert "\n" not in told.split("symsurf:")[0]


@pytest.mark.parametrize(
    ("elapsed", "fraction", "says"),
    [
        (1, 0.5, ""),
        (60, 0, ", 60 s"),
        (600, None, ", 10 min"),
        (60, 1, ""),
        (10, 0.25, ", 30 s left"),
        (600, 0.5, ", 10 min left"),
        (36000, 0.5, ", 10 h left"),
    ],
)
def test_time_shown(elapsed, fraction, says):
    assert time_shown(elapsed, fraction) == says


def test_settings_name_what_was_chosen():
    task = FileTask(
        "a.xyz",
        "align",
        {"axis": "y", "up": np.array([0.0, 0.0, 1.0])},
        threads=3,
        method="plane",
    )
    assert task.settings == 'align axis="y" method="plane" up=[0.0, 0.0, 1.0]'
    assert FileTask("b.xyz", threshold=0.5, label=3).settings == "detect label=3 threshold=0.5"
    row = next(symsurf.batch(["none.xyz"], "align", axis="y"))
    assert row["settings"] == 'align axis="y"'
