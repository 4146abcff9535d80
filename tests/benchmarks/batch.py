"""How much faster many files are with two jobs: 100 meshes of 10^4 vertices, from the command line.

Prints for each number of jobs and threads the seconds, those of CPU, and how many times as fast as
one job the run is. Usage: batch.py [MESHES]
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pyvista

import symsurf
from symsurf.saving import write_whole
from symsurf.saving.ply_format import shape_ply_bytes

ROUNDS = 3  # the least of them counts


def bumpy_meshes(count: int, folder: Path) -> list[Path]:
    """Closed meshes that mirror in x, but for a dent."""
    sphere = pyvista.Icosphere(radius=1, nsub=5)
    points = np.array(sphere.points, dtype=float)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    _, y, z = points.T
    files = []
    for seed in range(count):
        a, b, c = np.random.default_rng(seed).uniform(0, 6, size=3)
        radius = 1 + 0.2 * np.sin(3 * y + a) + 0.2 * np.cos(2 * z + b) * y + 0.1 * np.cos(3 * z + c)
        dent = np.clip(1 - ((points - (0.8, 0.6, 0)) ** 2).sum(axis=1) / 0.2, 0, 1)
        made = points * (radius - 0.03 * dent**2)[:, None] * (1, 1.4, 0.8)
        files.append(folder / f"mesh{seed:03}.ply")
        write_whole(files[-1], shape_ply_bytes(symsurf.Shape(made, sphere.regular_faces), {}))
    return files


def seconds(files: list[Path], jobs: int, threads: int) -> tuple[float, float]:
    """Elapsed, and of CPU."""
    words = ["asymmetry", *map(str, files), "--jobs", str(jobs), "--threads", str(threads)]
    before, started = cpu(), time.perf_counter()
    subprocess.run([sys.executable, "-m", "symsurf", *words], check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - started, cpu() - before


def cpu() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    print(f"{count} meshes, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    print("jobs  threads  seconds   of CPU  times as fast")
    with TemporaryDirectory() as folder:
        files = bumpy_meshes(count, Path(folder))
        asked = [(1, 1), (2, 1), (1, 0)]
        # In turns: what else the machine does meets all alike.
        rounds = [[seconds(files, *each) for each in asked] for _ in range(ROUNDS)]
        best = [min(measured) for measured in zip(*rounds)]
        for (jobs, threads), (elapsed, used) in zip(asked, best):
            faster = best[0][0] / elapsed
            print(f"{jobs:4}  {threads or 'all':>7}  {elapsed:7.2f}  {used:7.2f}  {faster:13.2f}")


if __name__ == "__main__":
    main()
