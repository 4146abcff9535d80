"""Several processes give the answer of one: pvbatch under mpiexec, and pvserver with a client."""

from __future__ import annotations

import re
import shutil
import socket
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

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
