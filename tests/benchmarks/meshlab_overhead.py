"""What MeshLab costs beside the core: CPU seconds of a filter less those of symsurf.detect.

    build/venv/bin/python tests/benchmarks/meshlab_overhead.py PLUGIN [VERTICES]

PLUGIN is the double build of filter_symsurf.so. One thread, the least of five runs each.
"""

from __future__ import annotations

import sys
import time

import numpy as np
import pymeshlab

import symsurf

METHOD = "plane"


def lump(size: int) -> np.ndarray:
    rng = np.random.default_rng(0)
    half = rng.normal(size=(size // 2, 3)) * (1, 2, 3)
    half[:, 2] += 0.4 * half[:, 1] ** 2
    return np.vstack([half, half * (-1, 1, 1)])


def least_cpu(run, times: int = 5) -> float:
    taken = []
    for _ in range(times):
        argument = run(None)
        start = time.process_time()
        run(argument)
        taken.append(time.process_time() - start)
    return min(taken)


def main(plugin: str, size: int = 1_000_000) -> None:
    pymeshlab.load_plugin(plugin)
    points = lump(size)

    def in_core(argument):
        return points if argument is None else symsurf.detect(argument, METHOD, threads=1)

    def in_meshlab(argument):
        if argument is None:
            mesh_set = pymeshlab.MeshSet()
            mesh_set.add_mesh(pymeshlab.Mesh(vertex_matrix=points))
            return mesh_set
        return argument.apply_filter("compute_mirror_" + METHOD, threads=1)

    core, meshlab = least_cpu(in_core), least_cpu(in_meshlab)
    print(f"{size} vertices: symsurf.detect {core:.3f} s, in MeshLab {meshlab:.3f} s,")
    print(f"  overhead {meshlab - core:.3f} s")


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:3]))
