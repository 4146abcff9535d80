"""What symsurf takes beside the libraries that do a part of it, on the same shape in the same run.

    make bench

A row a size and library: its CPU seconds on one thread, and how many times as long symsurf takes.
Trees are built and asked once for the nearest point to the image of each point, of which `plane`
does more; surfaces for the closest place to the image of each vertex; remeshing and cutting are
whole calls. The medians of five calls in turn.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable

# One thread each; the libraries look at it when they are loaded.
os.environ |= {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")}

import igl
import numpy as np
import open3d
import pymeshlab
import pyvista
import vtkmodules.all as vtk
from accuracy.poses import Points
from pykdtree.kdtree import KDTree
from scipy.spatial import cKDTree

import symsurf
from symsurf import Plane, Shape

ROUNDS = 5
LEVELS = (5, 6, 7)  # of the icosphere: 10,242, 40,962 and 163,842 vertices
MIRROR = Plane((1, 0, 0), 0)

Call = Callable[[], object]


def body(level: int) -> pyvista.PolyData:
    """An uneven body that x = 0 mirrors but for a wave on one side."""
    mesh = pyvista.Icosphere(nsub=level)
    x, y, z = (unit := np.asarray(mesh.points, dtype=float)).T
    radius = 1 + 0.1 * np.sin(3 * y + 1) + 0.1 * z * x**2 + 0.05 * np.cos(9 * x) * np.cos(5 * y)
    points = unit * radius[:, None]
    points[:, 0] += 0.01 * np.sin(3 * points[:, 2]) * (x > 0)
    return pyvista.PolyData.from_regular_faces(points, mesh.regular_faces)


def trees(points: Points, images: Points) -> dict[str, Call]:
    def of_open3d() -> object:
        tensors = [open3d.core.Tensor(np.ascontiguousarray(rows)) for rows in (points, images)]
        tree = open3d.core.nns.NearestNeighborSearch(tensors[0])
        tree.knn_index()
        return tree.knn_search(tensors[1], 1)

    return {
        "symsurf plane": lambda: symsurf.detect(points, method="plane", threads=1),
        "SciPy cKDTree": lambda: cKDTree(points).query(images),
        "pykdtree": lambda: KDTree(points).query(images),
        "Open3D": of_open3d,
    }


def surfaces(mesh: pyvista.PolyData, shape: Shape, images: Points) -> dict[str, Call]:
    faces = mesh.regular_faces

    def of_vtk() -> object:
        locator = vtk.vtkStaticCellLocator()
        locator.SetDataSet(mesh)
        locator.BuildLocator()
        place, cell, sub, squared = [0.0] * 3, vtk.mutable(0), vtk.mutable(0), vtk.mutable(0.0)
        for image in images:
            locator.FindClosestPoint(image, place, cell, sub, squared)
        return place

    return {
        "symsurf asymmetry": lambda: symsurf.asymmetry(shape, MIRROR, threads=1),
        "igl closest points": lambda: igl.point_mesh_squared_distance(images, shape.points, faces),
        "VTK closest points": of_vtk,
    }


def remeshings(mesh: pyvista.PolyData, shape: Shape) -> dict[str, Call]:
    edge = float(np.sqrt(mesh.area / mesh.n_cells * 4 / np.sqrt(3)))

    def of_meshlab() -> object:
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(np.asarray(mesh.points), mesh.regular_faces))
        length = pymeshlab.PureValue(edge)
        meshes.meshing_isotropic_explicit_remeshing(targetlen=length, iterations=5)
        return meshes

    return {
        "symsurf remesh": lambda: symsurf.remesh(shape, MIRROR, threads=1),
        "pymeshlab remeshing": of_meshlab,
    }


def cuts(mesh: pyvista.PolyData, shape: Shape) -> dict[str, Call]:
    return {
        "symsurf cut": lambda: symsurf.cut(shape, MIRROR, threads=1),
        "VTK clip": lambda: mesh.clip_closed_surface(normal="x", origin=(0, 0, 0)),
    }


def seconds(calls: dict[str, Call]) -> dict[str, float]:
    spent: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(ROUNDS):
        for name, call in calls.items():
            start = time.process_time()
            call()
            spent[name].append(time.process_time() - start)
    return {name: float(np.median(all_of_them)) for name, all_of_them in spent.items()}


def main() -> None:
    print(f"{'vertices':>8}  {'library':24}{'CPU, s':>9}{'symsurf over it':>18}")
    for level in LEVELS:
        mesh = body(level)
        points = np.asarray(mesh.points)
        shape = Shape(points, mesh.regular_faces)
        images = points * (-1, 1, 1)
        for calls in (
            trees(points, images),
            surfaces(mesh, shape, images),
            remeshings(mesh, shape),
            cuts(mesh, shape),
        ):
            spent = seconds(calls)
            own = next(iter(spent.values()))
            for name, time_of_it in spent.items():
                print(f"{len(points):8}  {name:24}{time_of_it:9.3f}{own / time_of_it:18.2f}")


if __name__ == "__main__":
    main()
