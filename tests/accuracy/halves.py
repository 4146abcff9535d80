"""Meshes cut by mirrors of every kind: exact images, closed halves, even triangles, values carried."""

from __future__ import annotations

import time
from functools import cache

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import Mirror, Shape

from .case import Case, Figures, at_least, at_most
from .operations import _distances
from .poses import diagonal, random_rotation

MIRRORS = ("plane", "sphere", "cylinder", "height field")
NOISE = 0.0005  # of a vertex's coordinates, in radii: no vertices mirror each other
FINE = 0.01  # of the diagonal: the edges of a remeshed body


def body(rng: np.random.Generator, nsub: int = 5) -> Shape:
    """A closed body of low bumps, in a pose of its own."""
    import pyvista

    mesh = pyvista.Icosphere(nsub=nsub)
    unit = np.asarray(mesh.points, dtype=float)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    waves = rng.normal(size=(6, 3)) * 2
    radius = np.exp(0.06 * np.cos(unit @ waves.T + rng.uniform(0, 7, 6)).sum(axis=1))
    points = unit * radius[:, None] * rng.uniform(0.6, 1.4, 3)
    points += NOISE * rng.normal(size=points.shape)
    return Shape(points @ random_rotation(rng).T, mesh.regular_faces)


def mirror_through(shape: Shape, kind: str, rng: np.random.Generator) -> Mirror:
    """Near the body's middle, curved by a radius of 1.5 to 4 of its diagonals."""
    size = diagonal(shape.points)
    normal, across, along = random_rotation(rng)
    through = shape.points.mean(axis=0) + 0.05 * size * rng.normal(size=3)
    radius = size * rng.uniform(1.5, 4)
    if kind == "plane":
        return symsurf.Plane(normal, -normal @ through)
    if kind == "sphere":
        return symsurf.Sphere(through - radius * normal, radius)
    if kind == "cylinder":
        return symsurf.Cylinder(through - radius * normal, along, radius)
    u, v = (axis.ravel() for axis in np.meshgrid(*2 * [np.linspace(-1, 1, 25)]))
    height = 0.04 * size * np.sin(2 * u + rng.uniform(0, 7)) * np.cos(2 * v)
    nodes = through + size * (u[:, None] * across + v[:, None] * along)
    return symsurf.HeightField(normal, nodes + height[:, None] * normal)


def _is_closed(shape: Shape) -> float:
    return float(shape.to_pyvista().is_manifold)


def _symmetry(made: Shape, partner: NDArray[np.int64], mirror: Mirror) -> Figures:
    points, size = made.points, diagonal(made.points)
    images = partner[made.faces[:, [0, 2, 1]]]
    first = [np.argmin(faces, axis=1) for faces in (made.faces, images)]
    rolled = [
        np.take_along_axis(faces, (start[:, None] + np.arange(3)) % 3, axis=1)
        for faces, start in zip((made.faces, images), first)
    ]
    same = len(np.unique(np.vstack(rolled), axis=0)) == len(np.unique(rolled[0], axis=0))
    return {
        "partners": float(np.abs(mirror.reflect(points) - points[partner]).max()) / size,
        "faces": float(same),
        "closed": _is_closed(made),
    }


def _mirrored(kind: str, rng: np.random.Generator) -> Figures:
    shape = body(rng)
    mirror = mirror_through(shape, kind, rng)
    made = symsurf.symmetrize(shape, mirror, side="positive", triangles="mirrored")
    kept = mirror.signed_distance(made.shape.points) > 0
    off = _distances(made.shape.points[kept], shape).max() / diagonal(shape.points)
    return {**_symmetry(made.shape, made.partner, mirror), "kept side": float(off)}


def _remeshed(kind: str, rng: np.random.Generator) -> Figures:
    shape = body(rng)
    mirror = mirror_through(shape, kind, rng)
    size = diagonal(shape.points)
    made = symsurf.remesh(shape, mirror, edge_length=FINE)
    points, faces = made.shape.points, made.shape.faces
    kept = mirror.signed_distance(points) >= 0
    centres = points[faces[kept[faces].all(axis=1)]].mean(axis=1)
    off = _distances(np.vstack([points[kept], centres]), shape).max() / size
    edges = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=2) / size / FINE
    return {
        **_symmetry(made.shape, made.partner, mirror),
        "kept side": float(off),
        "even": float(((edges > 0.6) & (edges < 1.4)).mean()),
    }


def _halved(kind: str, rng: np.random.Generator) -> Figures:
    shape = body(rng)
    mirror = mirror_through(shape, kind, rng)
    halves = [symsurf.cut(shape, mirror, side=side) for side in ("positive", "negative")]
    whole = shape.to_pyvista().volume
    caps = [half.shape.points[half.shape.faces[half.cap]].reshape(-1, 3) for half in halves]
    off = max(np.abs(mirror.signed_distance(cap)).max() for cap in caps)
    return {
        "closed": min(_is_closed(half.shape) for half in halves),
        "cap": float(off) / diagonal(shape.points),
        "volume": abs(sum(half.shape.to_pyvista().volume for half in halves) / whole - 1),
    }


@cache
def _symmetric(seed: int) -> tuple[Shape, NDArray[np.int64]]:
    """A body whose vertices mirror each other over x = 0, and their partners."""
    import pyvista
    from scipy.spatial import KDTree

    mesh = pyvista.Icosphere(nsub=4)
    unit = np.asarray(mesh.points, dtype=float)
    unit[np.abs(unit[:, 0]) < 1e-6, 0] = 0
    partner = KDTree(unit).query(unit * (-1, 1, 1))[1]
    rng = np.random.default_rng(seed)
    moved = unit + 0.02 * rng.normal(size=unit.shape)
    points = (moved + moved[partner] * (-1, 1, 1)) / 2
    return Shape(points, mesh.regular_faces), partner


def _transferred(subject: str, rng: np.random.Generator) -> Figures:
    shape, partner = _symmetric(int(rng.integers(1000)))
    if subject == "flat shaded":  # every face with corners of its own
        corners = shape.faces.ravel()
        labels = rng.integers(0, 50, len(shape.faces)).repeat(3)
        points, faces = shape.points[corners], np.arange(len(corners)).reshape(-1, 3)
        own = {tuple(sorted(face)): k for k, face in enumerate(shape.faces.tolist())}
        of_face = [own[tuple(sorted(partner[face]))] for face in shape.faces]
        truth = labels.reshape(-1, 3)[of_face].ravel()
        shape = Shape(points, faces)
    else:
        labels = rng.integers(0, 1000, len(shape.points))
        truth = labels[partner]
    x = shape.points[:, 0]
    truth = np.where(x < 0, truth, labels)
    made = symsurf.transfer(labels, shape, symsurf.Plane((1, 0, 0), 0))
    return {"right labels": float((made.values == truth).mean())}


def _timed(operation: str, rng: np.random.Generator) -> Figures:
    mesh = body(rng, nsub=6)  # 81,920 faces
    mirror = mirror_through(mesh, "plane", rng)
    start = time.process_time()
    if operation == "mirrored":
        symsurf.symmetrize(mesh, mirror, side="positive", triangles="mirrored", threads=1)
    else:
        getattr(symsurf, operation)(mesh, mirror, threads=1)
    return {"seconds": time.process_time() - start}


EXACT = {"partners": at_most(1e-12), "faces": at_least(1), "closed": at_least(1)}
CASES = (
    Case("symmetrize, mirrored triangles", MIRRORS, _mirrored,
         {**EXACT, "kept side": at_most(1e-9)}, trials=8),
    Case("remesh, closed bodies", MIRRORS, _remeshed,
         {**EXACT, "kept side": at_most(0.001), "even": at_least(0.95)}, trials=8),
    Case("cut, closed bodies", MIRRORS, _halved,
         {"closed": at_least(1), "cap": at_most(1e-9), "volume": at_most(0.001)}, trials=8),
    Case("transfer, labels of exact meshes", ("vertices", "flat shaded"), _transferred,
         {"right labels": at_least(1)}),
    Case("halves, 82,000 faces", ("mirrored", "remesh", "cut"), _timed, {"seconds": at_most(5)},
         trials=3),
)  # fmt: skip
