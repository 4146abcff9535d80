"""Operations on meshes whose asymmetry, cut or bend is known."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import Mirror, Shape

from .case import Case, Figures, at_most
from .poses import Points, diagonal
from .solids import bent, mirrored_mesh

Faces = NDArray[np.int64]
EXACT = ("ball", "cow", "face")
"""Their vertices mirror each other."""
MEASURED = tuple(f"{mesh} {mirror}" for mesh in EXACT for mirror in ("plane", "cylinder"))
BUMP_RADIUS = 0.12  # of the diagonal


@cache
def _mesh(name: str) -> tuple[Points, Faces, Mirror]:
    if name != "ball":
        points, faces, plane = mirrored_mesh(name)
        return points, np.asarray(faces, dtype=np.int64), plane
    import pyvista

    made = pyvista.Icosphere(nsub=5)  # 10,242 vertices
    u = np.asarray(made.points, dtype=float)
    points = u * np.exp(0.2 * np.cos(2 * u[:, 1] + 1) + 0.1 * u[:, 2] * u[:, :1].T[0] ** 2)[:, None]
    return points, made.faces.reshape(-1, 4)[:, 1:], symsurf.Plane((1, 0, 0), 0.0)


def _bend(points: Points, plane: Mirror, kind: str) -> tuple[Points, Mirror]:
    return bent(points, plane, 0.8) if kind == "cylinder" else (points, plane)


def _vertex_normals(points: Points, faces: Faces) -> Points:
    a, b, c = (points[faces[:, k]] for k in range(3))
    normals = np.zeros_like(points)
    for k in range(3):
        np.add.at(normals, faces[:, k], np.cross(b - a, c - a))
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def bumped(
    points: Points, faces: Faces, plane: Mirror, height: float, rng: np.random.Generator
) -> tuple[Points, NDArray[np.intp], NDArray[np.bool_]]:
    """The points with a bump on one side, so high; its top, and what lies far from it and from its
    image."""
    radius = BUMP_RADIUS * diagonal(points)
    aside = np.flatnonzero(np.abs(plane.signed_distance(points)) > 1.2 * radius)
    top = rng.choice(aside)
    distance = np.linalg.norm(points - points[top], axis=1)
    profile = np.maximum(1 - (distance / radius) ** 2, 0) ** 2
    normals = _vertex_normals(points, faces)
    # Along one direction, and on one layer: thin parts are not blown up.
    profile *= np.maximum(normals @ normals[top], 0) > 0.2
    far = distance > 1.3 * radius
    far &= np.linalg.norm(plane.reflect(points) - points[top], axis=1) > 1.3 * radius
    return points + height * profile[:, None] * normals[top], top, far


def _bump(subject: str, rng: np.random.Generator) -> Figures:
    name, kind = subject.split()
    points, faces, plane = _mesh(name)
    height = rng.uniform(0.005, 0.02) * diagonal(points)
    raised, top, far = bumped(points, faces, plane, height, rng)
    flat, mirror = _bend(points, plane, kind)
    shape, _ = _bend(raised, plane, kind)
    result = symsurf.asymmetry(shape, mirror, faces=faces, threads=1)
    truth = _distances(shape[[top]], Shape(flat, faces))[0]
    return {
        "height error": abs(result.distance[top] / truth - 1),
        "elsewhere": float(np.nanmax(result.distance[far])) / diagonal(shape),
    }


def _dent(subject: str, rng: np.random.Generator) -> Figures:
    points, faces, plane = _mesh(subject)
    dented, _, far = bumped(points, faces, plane, -0.02 * diagonal(points), rng)
    shape, _ = _bend(dented, plane, "cylinder")
    over = {
        method: symsurf.asymmetry(
            shape, symsurf.detect(shape, method, faces=faces, threads=1), faces=faces, threads=1
        )
        for method in ("plane", "cylinder")
    }
    away = {m: np.sqrt(np.nanmean(result.distance[far] ** 2)) for m, result in over.items()}
    return {"curved to planar": away["cylinder"] / away["plane"]}


def _cut(subject: str, rng: np.random.Generator) -> Figures:
    name, kind = subject.split()
    points, faces, plane = _mesh(name)
    side = plane.signed_distance(points) * rng.choice((-1, 1))
    way = rng.normal(size=3)
    height = points @ way
    limit = np.quantile(height[side > 0], 1 - rng.uniform(0.1, 0.45))
    lost = (side > 0) & (height > limit)
    kept = faces[~lost[faces].any(axis=1)]
    shape, mirror = _bend(points, plane, kind)
    made = symsurf.complete(shape, mirror, faces=kept, threads=1)
    size = diagonal(shape)
    return {
        "added to uncut": _p95(made.shape, made.shape.faces[len(kept) :], Shape(shape, faces))
        / size,
        "uncut to completed": _p95(Shape(shape, faces), faces[lost[faces].any(axis=1)], made.shape)
        / size,
    }


def _distances(points: Points, surface: Shape) -> NDArray[np.float64]:
    import pyvista

    assert surface.faces is not None
    target = pyvista.PolyData.from_regular_faces(surface.points, surface.faces)
    _, closest = target.find_closest_cell(points, return_closest_point=True)
    return np.linalg.norm(points - closest, axis=1)


def _p95(of: Shape, faces: Faces, surface: Shape) -> float:
    """Of the faces' centroids, the distance from the surface that 95 % are within."""
    return float(np.quantile(_distances(of.points[faces].mean(axis=1), surface), 0.95))


def _straight(subject: str, rng: np.random.Generator) -> Figures:
    points, faces, plane = _mesh(subject)
    shape, mirror = _bend(points, plane, "cylinder")
    straight = symsurf.straighten(shape, mirror, faces=faces, threads=1)
    back = symsurf.straighten(straight.shape, straight.mirror, threads=1, back=True)
    ends = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]]])
    feet, flat = mirror.project(shape), straight.plane.project(straight.shape.points)
    before, after = (np.linalg.norm(x[ends[:, 0]] - x[ends[:, 1]], axis=1) for x in (feet, flat))
    long = before > np.median(before)
    return {
        "length change": float(np.quantile(np.abs(after[long] / before[long] - 1), 0.95)),
        "back and forth": float(np.abs(back.shape.points - shape).max()) / diagonal(shape),
    }


CASES = (
    Case("asymmetry, a bump of known height", MEASURED, _bump,
         {"height error": at_most(0.02), "elsewhere": at_most(0.001)}),
    Case("asymmetry, a bent and dented mesh", EXACT, _dent, {"curved to planar": at_most(0.1)}),
    Case("complete, 10 to 45 % of one side cut away", MEASURED, _cut,
         {"added to uncut": at_most(0.005), "uncut to completed": at_most(0.005)}),
    Case("straighten, a mesh bent about a cylinder", EXACT, _straight,
         {"length change": at_most(0.01), "back and forth": at_most(1e-9)}),
)  # fmt: skip
