"""symsurf's planes beside those of others, on the same points in the same run.

    make compare

A row a damage and detector: the share of the draws in which the plane is found (within 1 degree and
0.5 % of the diagonal), the median angle and offset, and the median seconds of CPU. Every shape is
one that comes with PyVista or is made by examples/python/shapes.py, in poses drawn at random.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
import warnings
from pathlib import Path

# One thread each; the libraries look at it when they are loaded.
os.environ |= {
    name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
}

import numpy as np
from accuracy.damage import falling_density, hole, noise
from accuracy.planes import difference
from accuracy.poses import Points, diagonal, random_rotation
from accuracy.solids import mirrored_mesh, sampled

from symsurf import Plane

from .detectors import DETECTORS

sys.path.insert(0, str(Path(__file__).parents[3] / "examples" / "python"))
import shapes

COUNT = 4096
DIAGONAL = 200  # what pyclarcs's lengths are for
DAMAGES = (
    "none",
    "noise of 1 %",
    "20 % missing in one piece",
    "noise, 20 % missing, uneven density",
)


def meshes() -> dict[str, tuple[Points, np.ndarray, Plane]]:
    made = {name: mirrored_mesh(name) for name in ("airplane", "ant")}
    for name, shape in (("head", shapes.head(5)), ("vertebra", shapes.vertebra())):
        made[name] = (shape.points, shape.faces, Plane((1, 0, 0), 0))
    return made


def drawn(
    mesh: tuple[Points, np.ndarray, Plane], damage: str, rng: np.random.Generator
) -> tuple[Points, Plane]:
    vertices, faces, plane = mesh
    points = sampled(vertices, faces, COUNT, rng)
    if "noise" in damage:
        points = noise(points, 0.01, rng)
    if "missing" in damage:
        points = points[hole(points, 0.2, rng)]
    if "density" in damage:
        points = points[falling_density(points, 4, rng)]
    rotation, scale = random_rotation(rng), DIAGONAL / diagonal(points)
    shift = rng.uniform(-DIAGONAL, DIAGONAL, size=3)
    moved = scale * points @ rotation.T + shift
    normal = rotation @ plane.normal
    return moved, Plane(normal, scale * plane.offset - normal @ shift)


def measured(draws: list[tuple[Points, Plane]], name: str) -> list[str]:
    angles, offsets, seconds = [], [], []
    for points, truth in draws:
        start = time.process_time()
        found = DETECTORS[name](points)
        seconds.append(time.process_time() - start)
        angle, offset = (90.0, 1.0) if found is None else difference(found, truth, points)
        angles.append(angle)
        offsets.append(offset)
    right = np.mean([a <= 1 and o <= 0.005 for a, o in zip(angles, offsets, strict=True)])
    return [f"{100 * right:.0f} %", f"{np.median(angles):.2f}", f"{100 * np.median(offsets):.3f}",
            f"{np.median(seconds):.3f}"]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=5, help="draws a shape and damage")
    parser.add_argument("--damage", choices=DAMAGES, help="this one alone")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    made = meshes()
    for detector in DETECTORS.values():  # what is compiled at first use is not measured
        detector(drawn(made["head"], "none", np.random.default_rng(99))[0])
    print("| damage | detector | found | angle, degrees | offset, % of the diagonal | CPU, s |")
    print("|---|---|---|---|---|---|")
    for row, damage in enumerate(DAMAGES):
        if options.damage not in (None, damage):
            continue
        draws = [
            drawn(mesh, damage, np.random.default_rng([row, column, seed]))
            for column, mesh in enumerate(made.values())
            for seed in range(options.seeds)
        ]
        for name in DETECTORS:
            print(f"| {damage} | {name} | {' | '.join(measured(draws, name))} |", flush=True)


if __name__ == "__main__":
    main()
