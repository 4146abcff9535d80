"""Solids: meshes sampled at random, bent, or random ones without any mirror."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import Cylinder, Plane

from .poses import Points

FOLDER = Path(os.environ.get("SYMSURF_SHAPES", Path(__file__).parents[3] / "shared" / "data"))
MESHES = ("ant", "airplane", "cow", "face")
ASYMMETRIC = ("bumpy", "lumps", "facets", "sheet")
FILES = {
    "cow": ("spot.obj",),
    "face": ("face.obj", "face_pairs.txt"),
    "fox": ("fox.ply",),
    "bent cow": ("bent_spot.ply",),
    "bent capsule": ("bent_capsule.ply",),
    "skull": ("skulls/A_J.ply",),
}
"""Of the shapes that are neither made here nor come with PyVista."""


def lacking(subject: str) -> list[str]:
    """Which files of its shape are not in the folder; a subject's name begins with the shape's."""
    needed = [files for shape, files in FILES.items() if f"{subject} ".startswith(f"{shape} ")]
    return [file for file in sum(needed, ()) if not (FOLDER / file).exists()]


def sampled(
    points: Points, faces: NDArray[np.int64], count: int, rng: np.random.Generator
) -> Points:
    """Points (count, 3), uniform over the triangles."""
    return sampled_with_triangles(points, faces, count, rng)[0]


def sampled_with_triangles(
    points: Points, faces: NDArray[np.int64], count: int, rng: np.random.Generator
) -> tuple[Points, NDArray[np.int64]]:
    """The same, and the triangle of each."""
    a, b, c = (points[faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    chosen = rng.choice(len(faces), size=count, p=area / area.sum())
    s, t = rng.random((2, count, 1))
    flip = s + t > 1
    s, t = np.where(flip, 1 - s, s), np.where(flip, 1 - t, t)
    return a[chosen] + s * (b - a)[chosen] + t * (c - a)[chosen], chosen


@cache
def mirrored_mesh(name: str) -> tuple[Points, NDArray[np.int64], Plane]:
    """A mesh and its plane of symmetry: "ant" and "airplane" come with PyVista, others from the
    folder of shapes."""
    if name in ("ant", "airplane"):
        import pyvista
        from pyvista import examples

        mesh = pyvista.read(examples.antfile if name == "ant" else examples.planefile)
        mesh = mesh.triangulate().clean()
        points, faces = np.asarray(mesh.points, dtype=float), mesh.faces.reshape(-1, 4)[:, 1:]
        return points, faces, Plane((1, 0, 0), 0.0 if name == "ant" else -896.9943)
    shape = symsurf.read(FOLDER / FILES[name][0])
    plane = _face_plane(shape.points) if name == "face" else Plane((1, 0, 0), 0.0)
    return shape.points, shape.faces, plane


def _face_plane(points: Points) -> Plane:
    """From the list that says which vertex mirrors which."""
    lines = (FOLDER / "face_pairs.txt").read_text().splitlines()
    numbers = [line.split("#")[0].strip() for line in lines]
    partner = np.array([int(number) for number in numbers if number])[: len(points)] - 1
    chords = points[partner] - points
    moved = np.linalg.norm(chords, axis=1) > 1e-6
    normal = np.linalg.svd(chords[moved], full_matrices=False)[2][0]
    return Plane(normal, -normal @ (points + points[partner])[moved].mean(axis=0) / 2)


def bent(points: Points, plane: Plane, radius: float) -> tuple[Points, Cylinder]:
    """The points and their mirror after the plane was bent into a cylinder of that radius, in
    units of the points' extent along it, which is the longer one."""
    across = np.linalg.svd(plane.normal[None])[2][1:]
    along, axis = sorted(across, key=lambda way: np.ptp(points @ way), reverse=True)
    height = plane.signed_distance(points)
    radius *= np.ptp(points @ along)
    angle = (points @ along - (points @ along).mean()) / radius
    x = (radius + height) * np.cos(angle) - radius
    bent = np.column_stack([x, points @ axis, (radius + height) * np.sin(angle)])
    return bent, Cylinder((-radius, 0, 0), (0, 1, 0), radius)


def asymmetric(kind: str, count: int, rng: np.random.Generator) -> Points:
    """A random solid without a mirror: "bumpy" ball, "lumps", "facets" or an open "sheet"."""
    if kind == "lumps":
        return _lumps(count, rng)
    if kind == "sheet":
        return _sheet(count, rng)
    directions, radius = _radii(kind, 12 * count, rng)
    kept = rng.random(len(radius)) < (radius / radius.max()) ** 2
    return (directions * radius[:, None])[kept][:count]


def filled(kind: str, count: int, rng: np.random.Generator) -> Points:
    """Points all over the inside of a random solid without a mirror: a "bumpy" ball or "facets"."""
    directions, radius = _radii(kind, 30 * count, rng)
    kept = rng.random(len(radius)) < (radius / radius.max()) ** 3
    depth = rng.random(len(radius)) ** (1 / 3)
    return (directions * (radius * depth)[:, None])[kept][:count]


def _radii(kind: str, count: int, rng: np.random.Generator) -> tuple[Points, NDArray[np.float64]]:
    """Random directions, and how far the solid reaches there."""
    directions = rng.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return directions, (bumps if kind == "bumpy" else _facets)(directions, rng)


def bumps(directions: Points, rng: np.random.Generator) -> NDArray[np.float64]:
    waves = rng.normal(size=(12, 3)) * rng.uniform(1, 4, size=(12, 1))
    phases = rng.uniform(0, 2 * np.pi, size=12)
    bumps = np.cos(directions @ waves.T + phases) @ rng.normal(size=12)
    return np.exp(rng.uniform(0.2, 0.5) * (bumps - bumps.mean()) / bumps.std())


def _facets(directions: Points, rng: np.random.Generator) -> NDArray[np.float64]:
    # Twelve around, so that every direction meets one, of any tilt and distance.
    normals = rng.normal(size=(12, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.vstack([normals, -normals[:6] + 0.3 * rng.normal(size=(6, 3))])
    facing = directions @ normals.T
    distances = rng.uniform(0.5, 1.5, size=len(normals))
    return np.min(np.where(facing > 0.2, distances / np.maximum(facing, 0.2), 3), axis=1)


def _lumps(count: int, rng: np.random.Generator) -> Points:
    pieces, bodies = [], []
    for _ in range(6):
        matrix = np.diag(rng.uniform(0.25, 0.7, size=3)) @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
        bodies.append((rng.uniform(-0.8, 0.8, size=3), matrix))
    for k, (centre, matrix) in enumerate(bodies):
        ball = rng.normal(size=(2 * count, 3))
        points = ball / np.linalg.norm(ball, axis=1, keepdims=True) @ matrix + centre
        for other, (middle, shape) in enumerate(bodies):
            if other != k:
                inside = np.linalg.norm((points - middle) @ np.linalg.inv(shape), axis=1) < 1
                points = points[~inside]
        pieces.append(points)
    points = np.vstack(pieces)
    return points[rng.permutation(len(points))[:count]]


def _sheet(count: int, rng: np.random.Generator) -> Points:
    places = rng.uniform(-1, 1, size=(4 * count, 2))
    outline = 0.75 + 0.2 * np.cos(
        np.arctan2(places[:, 1], places[:, 0])[:, None] * np.arange(1, 5)
        + rng.uniform(0, 6, size=4)
    ) @ rng.normal(size=4)  # fmt: skip
    places = places[np.linalg.norm(places, axis=1) < outline][:count]
    waves, phases = rng.normal(size=(8, 2)) * 3, rng.uniform(0, 6, size=8)
    height = np.cos(places @ waves.T + phases) @ rng.normal(size=8) * 0.15
    return np.column_stack([places, height])
