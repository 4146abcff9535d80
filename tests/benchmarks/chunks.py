"""How detect_chunks grows: time, memory and error from 10^6 points up, which are made as they pass.

Prints for each number of points the seconds that making the chunks takes alone, those with the mirror
found, the peak of memory, and how far the plane is off; up to ``--whole`` points also those of
``detect`` with all of them in memory, and with ``--workers`` the seconds of one and two workers of
Dask. Usage: chunks.py [--powers 6 7 8] [--whole 8] [--workers 7]
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

import symsurf

CHUNK = 1_000_000
NOISE = 0.001  # of the diagonal, about
AXES = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
CENTRE = np.array([3.0, -2.0, 7.0])


def chunk(number: int, count: int = CHUNK) -> NDArray[np.float64]:
    """Of a bumpy body with noise and a mirror through CENTRE across the first of AXES."""
    random = np.random.default_rng(number)
    directions = random.normal(size=(count, 3))
    directions /= np.sqrt(np.einsum("ij,ij->i", directions, directions))[:, None]
    x, y, z = directions.T
    radius = 1 + 0.2 * np.sin(3 * y + z) + 0.15 * x * x * z
    points = directions * radius[:, None] * (1, 1.5, 2)
    points += random.normal(scale=5 * NOISE, size=(count, 3))
    return points @ AXES.T + CENTRE


def chunks(count: int) -> Callable[[], Iterator[NDArray[np.float64]]]:
    return lambda: (chunk(number) for number in range(count // CHUNK))


def error_of(result: symsurf.Result, points: NDArray[np.float64]) -> tuple[float, float]:
    """Degrees, and percent of the diagonal at the centre."""
    sine = np.linalg.norm(np.cross(result.mirror.normal, AXES[:, 0]))
    gap = abs(result.mirror.signed_distance(CENTRE[None])[0])
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    return float(np.degrees(np.arcsin(sine))), float(100 * gap / diagonal)


def run(kind: str, count: int) -> dict[str, float]:
    started = time.perf_counter()
    figures: dict[str, float] = {}
    if kind == "read":
        for _ in chunks(count)():
            pass
    elif kind == "chunks":
        found = symsurf.detect_chunks(chunks(count), "plane")
        figures["degrees"], figures["percent"] = error_of(found, np.asarray(found.points))
    elif kind == "whole":
        points = np.empty((count, 3))
        for number in range(count // CHUNK):
            points[number * CHUNK :][:CHUNK] = chunk(number)
        started = time.perf_counter()
        found = symsurf.detect(points, "plane", pairs=False)
        figures["degrees"], figures["percent"] = error_of(found, points[::1000])
    else:
        return {"seconds": dask_seconds(count, int(kind.removeprefix("dask")))}
    figures["seconds"] = time.perf_counter() - started
    figures["megabytes"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
    return figures


def dask_seconds(count: int, workers: int) -> float:
    import dask.array
    import distributed

    blocks = dask.array.map_blocks(
        lambda block_info=None: chunk(block_info[None]["chunk-location"][0]),
        chunks=((CHUNK,) * (count // CHUNK), (3,)),
        dtype=float,
        meta=np.empty((0, 3)),
    )
    with (
        distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster),
    ):
        symsurf.detect_chunks(blocks[:CHUNK], "plane")  # the workers are there, and have imported
        started = time.perf_counter()
        symsurf.detect_chunks(blocks, "plane")
        return time.perf_counter() - started


def measured(kind: str, count: int) -> dict[str, float]:
    """In a process of its own, whose peak of memory is that of this run alone. Chunks are made on one
    thread: those of BLAS would wait on the other processor."""
    done = subprocess.run(
        [sys.executable, __file__, "--run", kind, str(count)],
        check=True, capture_output=True, text=True, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
    )  # fmt: skip
    return json.loads(done.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--powers", nargs="+", type=int, default=[6, 7, 8])
    parser.add_argument(
        "--whole", type=int, default=7, help="the most that detect gets, as a power"
    )
    parser.add_argument("--workers", type=int, help="of Dask, on so many points, as a power")
    parser.add_argument("--run", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.run:
        print(json.dumps(run(options.run[0], int(options.run[1]))))
        return
    print("points  making s  with the mirror s  times  peak MB  degrees  % of diagonal")
    for power in options.powers:
        count = 10**power
        read, found = measured("read", count), measured("chunks", count)
        print(f"10^{power}  {read['seconds']:8.1f}  {found['seconds']:17.1f}  "
              f"{found['seconds'] / read['seconds']:5.2f}  {found['megabytes']:7.0f}  "
              f"{found['degrees']:7.4f}  {found['percent']:8.5f}", flush=True)  # fmt: skip
        if power <= options.whole:
            whole = measured("whole", count)
            print(f"  all in memory  {whole['seconds']:14.1f}         {whole['megabytes']:7.0f}  "
                  f"{whole['degrees']:7.4f}  {whole['percent']:8.5f}", flush=True)  # fmt: skip
    if options.workers:
        one, two = (
            measured(f"dask{workers}", 10**options.workers)["seconds"] for workers in (1, 2)
        )
        print(
            f"Dask, 10^{options.workers}: one worker {one:.1f} s, two {two:.1f} s, {two / one:.2f}"
        )


if __name__ == "__main__":
    main()
