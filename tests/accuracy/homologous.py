"""Homologous points: of shapes whose one side is deformed by a known smooth map, and meshed anew."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import Shape

from .case import Case, Figures, at_least, at_most, within
from .poses import diagonal, random_rotation

AMOUNTS = {"0.3 %": 0.003, "2 %": 0.02}
"""Root mean square of the deformation over the side, in diagonals."""
BODIES = {"smooth": 0.0, "detailed": 0.004}
"""Height of the details, in radii: wavelengths of 3 to 6 % of the diagonal, as a face's. Without them a
body has no features that are finer than its deformation."""
ELLIPSOID = "ellipsoid"  # has no relief
FACES = ("face remeshed", "face decimated")
"""Open sheets with the relief of a face: one triangulation of points without twins; and one with twins
whose sides are decimated separately."""
RELIEF = np.array([
    # x, y, width in x, width in y, height; those beside the midline stand on both sides
    (0, -0.05, 0.10, 0.30, 0.20),  # bridge of the nose
    (0, -0.22, 0.14, 0.12, 0.16),  # tip
    (0.13, -0.26, 0.07, 0.08, 0.06),  # wings
    (0.30, 0.38, 0.20, 0.08, 0.06),  # brows
    (0.30, 0.20, 0.15, 0.10, -0.10),  # eyes
    (0.42, -0.10, 0.18, 0.16, 0.08),  # cheeks
    (0, -0.50, 0.25, 0.04, 0.05),  # lips
    (0, -0.62, 0.22, 0.05, 0.05),
    (0, -0.56, 0.24, 0.02, -0.03),  # between them
    (0, -0.88, 0.18, 0.12, 0.10),  # chin
])  # fmt: skip
NOISE = 0.003  # of a sheet's heights while it is decimated
DENSITY = 10_000  # points of a sheet
DECIMATED = (0.45, 0.65)  # shares of the faces that either side loses
WAVE = 0.5  # diagonals: wavelengths lie within 0.6 and 1.4 of it
SEAM = 0.15  # diagonals from the mirror over which the deformation sets in

Points = NDArray[np.float64]


def _symmetric(unit: Points, details: float, rng: np.random.Generator) -> Points:
    """Of points of the unit sphere those of a body with features, the same on both sides of x = 0."""
    x, y, z = unit.T
    radius = 1 + 0.1 * np.sin(3 * y + 1) + 0.1 * z * x**2 + 0.05 * np.cos(9 * x) * np.cos(5 * y)
    radius += 0.06 * np.sin(7 * z + 2 * y) * (1 - x**2)
    waves = rng.normal(size=(12, 3))
    waves *= rng.uniform(30, 60, (12, 1)) / np.linalg.norm(waves, axis=1, keepdims=True)
    for (across, *along), phase in zip(waves, rng.uniform(0, 2 * np.pi, 12)):
        radius += details * np.cos(across * x) * np.sin(unit[:, 1:] @ along + phase)
    return unit * radius[:, None]


class SideMap:
    """Plane waves that move the side of positive x, normal and tangential to the surface."""

    def __init__(self, points: Points, amount: float, rng: np.random.Generator) -> None:
        size = diagonal(points)
        across = rng.normal(size=(3, 3))
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        self._waves = 2 * np.pi / (WAVE * size) / rng.uniform(0.6, 1.4, (3, 1)) * across
        self._phases = rng.uniform(0, 2 * np.pi, 3)
        self._ways = rng.normal(size=(3, 3))
        self._seam = SEAM * size
        self._unit = 1.0
        side = self(points)[points[:, 0] > 0] - points[points[:, 0] > 0]
        self._unit = amount * size / np.sqrt((side**2).sum(axis=1).mean())

    def __call__(self, points: Points) -> Points:
        near = np.clip(points[:, :1] / self._seam, 0, 1)
        moves = np.sin(points @ self._waves.T + self._phases) @ self._ways
        return points + self._unit * near**2 * (3 - 2 * near) * moves


def _closed(body: str, rng: np.random.Generator) -> Shape:
    """A body without vertices that have twins."""
    import pyvista

    mesh = pyvista.Icosphere(nsub=5)  # 10,242 vertices
    unit = np.asarray(mesh.points, dtype=float)
    unit = unit @ random_rotation(rng).T / np.linalg.norm(unit, axis=1, keepdims=True)
    is_bare = body == ELLIPSOID
    points = unit * (1, 0.8, 1.2) if is_bare else _symmetric(unit, BODIES[body], rng)
    return Shape(points, mesh.regular_faces)


def _face(body: str, rng: np.random.Generator) -> Shape:
    """A sheet over an oval of the plane, symmetric about x = 0 but for its triangles."""
    import pyvista

    own = RELIEF * (1 + 0.15 * rng.uniform(-1, 1, RELIEF.shape))
    beside = own[own[:, 0] != 0]
    features = np.concatenate([own, beside * (-1, 1, 1, 1, 1)])
    is_remeshed = body == FACES[0]
    radius = np.sqrt(np.linspace(0, 1, DENSITY // (1 if is_remeshed else 2)))
    turn = np.arange(len(radius)) * np.pi * (3 - np.sqrt(5)) + rng.uniform(0, 2 * np.pi)
    flat = np.column_stack([0.75 * radius * np.cos(turn), radius * np.sin(turn)])
    if not is_remeshed:
        spacing = np.sqrt(0.75 * np.pi / len(flat))
        half = flat[flat[:, 0] > spacing / 2]
        seam = np.arange(-1, 1, spacing)
        flat = np.concatenate([half, half * (-1, 1), np.column_stack([0 * seam, seam])])
    x = flat[:, 0]

    def on_relief(flat: Points) -> Points:
        away = (flat[:, None] - features[:, :2]) / features[:, 2:4]
        relief = np.exp(-(away**2).sum(axis=2)) @ features[:, 4]
        return np.column_stack([flat, relief - flat**2 @ (0.5, 0.15)])

    faces = pyvista.PolyData(np.column_stack([flat, 0 * x])).delaunay_2d().regular_faces
    if is_remeshed:
        return Shape(on_relief(flat), faces)
    right = faces[np.isin(faces, np.flatnonzero(x >= 0)).all(axis=1)]
    left = np.concatenate([np.roll(np.arange(2 * len(half)), len(half)),
                           np.arange(2 * len(half), len(x))])[right[:, ::-1]]  # fmt: skip
    # Of either side other vertices are kept: by heights with noise.
    points = on_relief(flat) + rng.normal(scale=NOISE, size=(len(x), 1)) * (0, 0, 1)
    parts = [
        pyvista.PolyData.from_regular_faces(points, side)
        .clean()
        .decimate_pro(lost, preserve_topology=True, boundary_vertex_deletion=False)
        for side, lost in zip((right, left), DECIMATED)
    ]
    whole = pyvista.merge(parts).extract_surface(algorithm=None).clean(tolerance=1e-9).triangulate()
    return Shape(on_relief(np.asarray(whole.points, dtype=float)[:, :2]), whole.regular_faces)


def _deformed(subject: str, rng: np.random.Generator) -> Figures:
    body, amount = subject.split(", ")
    symmetric = (_face if body in FACES else _closed)(body, rng)
    points = symmetric.points
    moved_by = SideMap(points, AMOUNTS[amount], rng)
    moved = moved_by(points)
    places = moved_by(points * (-1, 1, 1)) * (-1, 1, 1)
    start = time.process_time()
    found = symsurf.asymmetry(
        Shape(moved, symmetric.faces),
        symsurf.Plane((1, 0, 0), 0),
        pairing="homologous",
        threads=1,
    )
    seconds = time.process_time() - start
    known = np.isfinite(found.vector).all(axis=1)
    vector, truth = found.vector[known], (places - moved)[known]
    assert found.vector_sd is not None
    off = np.linalg.norm(vector - truth, axis=1)
    deviation = found.vector_sd[known]
    estimated = deviation > 0  # the others are vertices of one triangulation
    length = np.sqrt(np.mean(truth**2))
    return {
        "error": float(np.sqrt(np.mean((vector - truth) ** 2)) / length),
        "correlation": float(np.corrcoef(vector.ravel(), truth.ravel())[0, 1]),
        "length": float(np.sqrt(np.mean(vector**2)) / length),
        "error over deviation": float(
            np.sqrt(np.mean((off[estimated] / deviation[estimated]) ** 2))
        ),
        "known": found.statistics["known_share"],
        "seconds": seconds,
    }


_RELIEF = tuple(f"{body}, {amount}" for body in BODIES for amount in AMOUNTS)
_BARE = tuple(f"{ELLIPSOID}, {amount}" for amount in AMOUNTS)
_FACES = tuple(f"{face}, {amount}" for face in FACES for amount in AMOUNTS)
_COST = {
    "length": at_most(1.1),
    "error over deviation": within(0.6, 1.4),
    "seconds": at_most(3),
}

CASES = (
    Case("homologous points, relief", _RELIEF, _deformed,
         {"error": at_most(0.6), "correlation": at_least(0.8), **_COST}),
    Case("homologous points, faces", _FACES, _deformed,
         {"error": at_most(0.58), "correlation": at_least(0.65), **_COST}),
    Case("homologous points, no relief", _BARE, _deformed,
         {"error": at_most(1.05), **_COST}),
)  # fmt: skip
