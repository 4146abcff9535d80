"""What a wheel must do once it is installed: find a mirror, and cut a mesh, which OpenMesh is for. Prints the seconds
from the import on."""

import time

started = time.perf_counter()

import numpy as np

import symsurf

points = np.random.default_rng(0).normal(size=(500, 3)) * (1, 2, 3) + (4, 0, 0)
points = np.concatenate([points, points * (-1, 1, 1)])
result = symsurf.detect(points)
assert result.verdict == "found"
assert np.abs(result.mirror.normal - (1, 0, 0)).max() < 1e-9, result.mirror

corners = np.array(list(np.ndindex(2, 2, 2)), dtype=float) * (1, 2, 3)
faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
         [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]  # fmt: skip
box = symsurf.Shape(corners, faces=np.array(faces))
asymmetry = symsurf.asymmetry(box)
assert asymmetry.statistics["rms"] < 1e-9
remeshed = symsurf.remesh(box, edge_length=0.1)
assert len(remeshed.shape.faces) > 50

print(f"symsurf {symsurf.__version__}: {time.perf_counter() - started:.1f} s")
