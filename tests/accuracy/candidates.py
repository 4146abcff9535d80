"""Bodies with several planes of symmetry: all are among the candidates, and nothing else is."""

from __future__ import annotations

import numpy as np

from symsurf import Plane

from .case import Case, Figures, at_least, timed_detect
from .pieces import gear_outline, loft
from .planes import difference
from .poses import Points, random_rotation

Body = tuple[Points, Points]
"""Points, and the normals of their planes of symmetry, which pass through their centroid."""

HIGH = 0.9
"""A score that a plane without exact partners must not have."""


def _around(order: int) -> Points:
    """Normals of the planes of a body that so many turns about z bring back: upright, and z."""
    angle = np.pi * np.arange(order) / order
    upright = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    return np.vstack([upright, [0, 0, 1]])


def _grid(sides: np.ndarray, cells: np.ndarray, surface_only: bool) -> Points:
    index = np.indices(cells + 1).reshape(3, -1).T
    if surface_only:
        index = index[((index == 0) | (index == cells)).any(axis=1)]
    return index * (sides / cells)


def _box(style: str, rng: np.random.Generator) -> Body:
    """2 x 4 x 6: a lattice on the surface, or inside too, or a mesh with other steps each way."""
    sides = np.array([2, 4, 6])
    cells = sides * rng.integers(2, 6)
    if style == "mesh":
        cells = rng.integers(3, 24, size=3)
    return _grid(sides, cells, style != "grid"), np.eye(3)


def _cube(style: str, rng: np.random.Generator) -> Body:
    points = _grid(np.ones(3), np.full(3, rng.integers(5, 16)), style != "grid")
    diagonals = [(0, 1, 1), (0, 1, -1), (1, 0, 1), (1, 0, -1), (1, 1, 0), (1, -1, 0)]
    return points, np.vstack([np.eye(3), np.array(diagonals) / np.sqrt(2)])


def _hexagonal_prism(style: str, rng: np.random.Generator) -> Body:
    steps = int(rng.integers(3, 12))
    levels = np.linspace(0, rng.uniform(0.5, 3), rng.integers(4, 16))
    if style == "mesh":
        corners = np.exp(1j * np.pi * np.arange(7) / 3)
        share = np.arange(steps) / steps
        edge = (corners[:-1, None] * (1 - share) + corners[1:, None] * share).ravel()
        outline = np.column_stack([edge.real, edge.imag])
        rings = [np.column_stack([outline, np.full(len(outline), z)]) for z in levels]
        return loft(rings)[0], _around(6)
    first, second = np.indices((2 * steps + 1, 2 * steps + 1)).reshape(2, -1) - steps
    out = np.max(np.abs([first, second, first + second]), axis=0)
    places = np.column_stack([first + second / 2, second * np.sqrt(3) / 2]) / steps
    layers = []
    for k, z in enumerate(levels):
        kept = places[out <= steps if k in (0, len(levels) - 1) else out == steps]
        layers.append(np.column_stack([kept, np.full(len(kept), z)]))
    return np.vstack(layers), _around(6)


def _gear(style: str, rng: np.random.Generator) -> Body:
    outline, height = gear_outline(12, rng.uniform(0.1, 0.3)), rng.uniform(0.2, 0.8)
    shares = np.linspace(0.2, 1, int(rng.integers(3, 8)))
    levels = np.linspace(0, height, int(rng.integers(3, 8)))[1:-1]
    profile = [*((s, 0) for s in shares), *((1, z) for z in levels)]
    profile += [(s, height) for s in shares[::-1]]
    rings = [np.column_stack([s * outline, np.full(len(outline), z)]) for s, z in profile]
    return loft(rings)[0], _around(12)


def _bracket(style: str, rng: np.random.Generator) -> Body:
    """An L with legs of different length: only the plane across its width is one."""
    thick, width = rng.integers(2, 5), rng.integers(6, 14)
    first = rng.integers(8, 14)
    x, y, z = np.indices((first, first + rng.integers(3, 9), width)).reshape(3, -1)
    return np.column_stack([x, y, z])[(x < thick) | (y < thick)].astype(float), np.eye(3)[2:]


BODIES = {
    "box": _box, "hexagonal-prism": _hexagonal_prism, "cube": _cube, "gear": _gear,
    "L-bracket": _bracket,
}  # fmt: skip
SUBJECTS = (
    "box lattice", "box mesh", "box grid", "hexagonal-prism lattice", "hexagonal-prism mesh",
    "cube lattice", "cube grid", "gear mesh", "L-bracket grid",
)  # fmt: skip


def _all_planes(method: str) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        body, style = subject.split()
        points, normals = BODIES[body](style, rng)
        rotation = random_rotation(rng)
        points = rng.permutation(points - points.mean(axis=0)) @ rotation.T
        truths = [Plane(normal, 0.0) for normal in normals @ rotation.T]
        result, seconds = timed_detect(points, method)
        found = [(result.mirror, result.score), *((c.mirror, c.score) for c in result.candidates)]
        found = [(mirror, score) for mirror, score in found if isinstance(mirror, Plane)]
        hits, wrong = np.zeros(len(truths)), 0
        for mirror, score in found:
            errors = [difference(mirror, truth, points) for truth in truths]
            close = [angle <= 0.1 and offset <= 0.001 for angle, offset in errors]
            hits += close
            wrong += score >= HIGH and not any(close)
        return {
            "all found": float((hits > 0).all()),
            "none false": float(wrong == 0),
            "none twice": float((hits <= 1).all()),
            "share found": float((hits > 0).mean()),
            "score": result.score,
            "seconds": seconds,
        }

    bars = {name: at_least(1) for name in ("all found", "none false", "none twice")}
    return Case(f"{method}, all planes of a body", SUBJECTS, run, bars)


CASES = (_all_planes("plane"), _all_planes("auto"))
