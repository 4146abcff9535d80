"""Several processes give the answer of one: pvbatch under mpiexec, and pvserver with a client."""

from __future__ import annotations

import re
import shutil
import socket
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import symsurf

NORMAL = np.array([2.0, -1.0, 0.5]) / np.linalg.norm([2.0, -1.0, 0.5])


def pvbatch(processes: int) -> str:
    return f"mpiexec --oversubscribe -n {processes} pvbatch --symmetric"


def plane(answer: dict[str, Any]) -> np.ndarray:
    """Normal and offset, with the sign of the true normal."""
    numbers = np.array(answer["field"]["Normal"] + answer["field"]["Offset"])
    return numbers * np.sign(numbers[:3] @ NORMAL)


def check_same(answer: dict[str, Any], one: dict[str, Any]) -> None:
    assert np.abs(plane(answer) - plane(one)).max() < 1e-9
    assert abs(answer["field"]["Score"][0] - one["field"]["Score"][0]) < 1e-9
    # The mesh is laid over a sample of the points, which hangs on their order.
    assert np.abs(np.subtract(answer["bounds"], one["bounds"])).max() < 0.1
    assert answer["surface_points"] == one["surface_points"]
    assert answer["partners"] == one["partners"]
    assert np.abs(np.subtract(answer["residuals"], one["residuals"])).max() < 1e-9
    sides = np.array(one["sides"]) * np.sign(np.array(one["field"]["Normal"]) @ NORMAL)
    again = np.array(answer["sides"]) * np.sign(np.array(answer["field"]["Normal"]) @ NORMAL)
    assert np.array_equal(sides, again)


@pytest.fixture
def one(run_host: Callable[..., Any]) -> dict[str, Any]:
    """What a single process finds; the known mirror."""
    answer = run_host("pvbatch", "shared_shape.py", "interleaved")
    assert np.abs(plane(answer) - [*NORMAL, -0.4]).max() < 1e-9
    partners = np.array(answer["partners"])
    assert np.array_equal(partners[partners], np.arange(12000))
    return answer


def test_processes_agree(run_host: Callable[..., Any], one: dict[str, Any]) -> None:
    for processes, how in [(1, "slabs"), (2, "slabs"), (2, "first_only"), (3, "interleaved")]:
        check_same(run_host(pvbatch(processes), "shared_shape.py", how), one)


def test_a_process_without_points(run_host: Callable[..., Any], tmp_path: Path) -> None:
    """No hang; the result of the whole, or the same error on all."""
    random = np.random.default_rng(5)
    x = random.normal(size=(6000, 3))
    x /= np.linalg.norm(x, axis=1)[:, None]
    x *= 1 + 0.3 * np.sin(3 * x[:, :1] + x[:, 1:2]) + 0.2 * x[:, 1:2] * x[:, 2:]
    points = np.vstack([x, x * (-1, 1, 1) + (0.5, 0, 0)])
    np.save(tmp_path / "points.npy", points)
    processes = run_host(pvbatch(3), "empty_process.py", tmp_path / "points.npy")
    whole = {method: symsurf.detect(points, method) for method in ("plane", "sphere")}
    assert whole["plane"].score == 1
    for ranks in zip(*processes):
        (method, name, root), said = ranks[0], [rank[2]["ErrorEvent"] for rank in ranks]
        warned = [rank[2]["WarningEvent"] for rank in ranks]
        if name.startswith("nobody") or name == "no shape":
            # The filter's sentence on each process, in which VTK reports it.
            sentences = [
                re.sub(r"\(0x[0-9a-f]+\)", "", error) for errors in said for error in errors
            ]
            assert len(sentences) == 3 and len(set(sentences)) == 1, (method, name, said)
            reasons = {
                "no shape": "the input is a vtkTable",
                "nobody has points": "0 points given",
                "nobody has a finite point": "0 of 150 points given",
            }
            assert reasons[name] in said[0][0]
            continue
        assert said == [[], [], []], (method, name)
        assert len(warned[0]) == (name == "no finite point") and warned[1:] == [[], []]
        assert sum(rank[2]["pairs"] for rank in ranks) == len(whole[method].pairs)
        assert ranks[1][2]["pairs"] == 0
        for rank in ranks:
            assert rank[2]["score"] == root["score"]
            assert abs(rank[2]["score"][0] - whole[method].score) < 1e-9


@contextmanager
def server(processes: int, environment: dict[str, str]) -> Iterator[int]:
    """pvserver on a free port, until the client leaves."""
    if shutil.which("pvserver") is None:
        pytest.skip("pvserver is not installed")
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        port = probe.getsockname()[1]
    command = f"mpiexec --oversubscribe -n {processes} pvserver --server-port={port}"
    process = subprocess.Popen(
        command.split(),
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        for line in process.stdout:
            if re.search("Accepting connection|Waiting for client", line):
                break
        yield port
    finally:
        process.terminate()
        process.wait(30)


def test_client_and_server(
    run_host: Callable[..., Any], environment: dict[str, str], one: dict[str, Any]
) -> None:
    with server(2, environment) as port:
        check_same(run_host("pvpython", "shared_shape.py", "slabs", port), one)


def test_an_operation_wants_all_points_in_one_process(run_host: Callable[..., Any]) -> None:
    seen = run_host("pvbatch", "shared_operation.py")
    assert seen["shared"] == seen["gathered"] == seen["points"] > 0
    seen = run_host(pvbatch(2), "shared_operation.py")
    assert seen["shared"] == 0  # an error of both processes, which live on
    assert seen["gathered"] == seen["points"] > 0
