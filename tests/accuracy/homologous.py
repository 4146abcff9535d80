"""Homologous points: of bodies whose one side is deformed by a known smooth map, and meshed anew."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import Shape

from .case import Case, Figures, at_least, at_most
from .poses import diagonal, random_rotation

AMOUNTS = {"0.3 %": 0.003, "2 %": 0.02}
"""Root mean square of the deformation over the side, in diagonals."""
BODIES = {"smooth": 0.0, "detailed": 0.004}
"""Height of the details, in radii: wavelengths of 3 to 6 % of the diagonal, as a face's. Without them a
body has no features that are finer than its deformation."""
ELLIPSOID = "ellipsoid"  # has no relief
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


def _deformed(subject: str, rng: np.random.Generator) -> Figures:
    import pyvista

    body, amount = subject.split(", ")
    mesh = pyvista.Icosphere(nsub=5)  # 10,242 vertices
    unit = np.asarray(mesh.points, dtype=float)
    unit = unit @ random_rotation(rng).T / np.linalg.norm(unit, axis=1, keepdims=True)
    # No vertex has a twin.
    is_bare = body == ELLIPSOID
    points = unit * (1, 0.8, 1.2) if is_bare else _symmetric(unit, BODIES[body], rng)
    moved_by = SideMap(points, AMOUNTS[amount], rng)
    moved = moved_by(points)
    places = moved_by(points * (-1, 1, 1)) * (-1, 1, 1)
    start = time.process_time()
    found = symsurf.asymmetry(
        Shape(moved, mesh.regular_faces),
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
_COST = {"length": at_most(1.1), "error over deviation": at_most(1.4), "seconds": at_most(3)}

CASES = (
    Case("homologous points, relief", _RELIEF, _deformed,
         {"error": at_most(0.6), "correlation": at_least(0.8), **_COST}),
    Case("homologous points, no relief", _BARE, _deformed,
         {"error": at_most(1.05), **_COST}),
)  # fmt: skip
