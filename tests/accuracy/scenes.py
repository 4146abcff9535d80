"""Scenes of which several maps are true: a facade, a chair, two objects, twins of uneven density."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .pieces import box, joined
from .poses import Points, random_rotation
from .solids import sampled

COUNT = 10_000
Matrix = NDArray[np.float64]


@dataclass
class Scene:
    points: Points
    maps: list[tuple[Matrix, Points]]
    """What maps a part onto another: (4, 4), and the middle of the part."""


def facade(rng: np.random.Generator) -> Scene:
    """A wall with three rows of four windows."""
    wall = [box((0, 0, 0), (12, 9, 0.4))]
    for x in (-4.5, -1.5, 1.5, 4.5):
        for y in (-3, 0, 3):
            wall += [
                *(box((x + s, y, 0.4), (0.2, 1.6, 0.6)) for s in (-0.6, 0.6)),
                box((x, y - 0.7, 0.5), (1.6, 0.2, 1)),
                box((x, y + 0.7, 0.4), (1.2, 0.2, 0.6)),
            ]
    steps = [_translation(3, 0, 0), _translation(0, 3, 0), _translation(3, 3, 0)]
    window = np.array([-1.5, 0, 0.4])
    maps = [(each, window) for each in (_reflection(), *steps)]
    return Scene(sampled(*joined(wall), COUNT, rng), maps)


def chair(rng: np.random.Generator) -> Scene:
    """Four square legs, a seat and a back."""
    parts = [box((0, 0, 0), (4, 4, 0.3)), box((0, -1.9, 2.5), (4, 0.3, 4))]
    parts += [box((x, y, -2), (0.4, 0.4, 4)) for x in (-1.7, 1.7) for y in (-1.7, 1.7)]
    leg = np.array([-1.7, -1.7, -2])
    maps = [(_reflection(), leg), (_translation(3.4, 0, 0), leg), (_translation(0, 3.4, 0), leg)]
    return Scene(sampled(*joined(parts), COUNT, rng), maps)


def two_objects(rng: np.random.Generator) -> Scene:
    """Two bodies beside each other, each with a mirror of its own."""
    bodies, maps = [], []
    for place in ((0, 0, 0), (4, 0, 0)):
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = random_rotation(rng), place
        bodies.append(_mirrored_ball(COUNT // 2, rng) @ pose[:3, :3].T + pose[:3, 3])
        maps.append((pose @ _reflection() @ np.linalg.inv(pose), np.array(place)))
    return Scene(np.vstack(bodies), maps)


def uneven_twins(rng: np.random.Generator) -> Scene:
    """Two equal bodies, one with a third of the other's points."""
    body = _mirrored_ball(COUNT, rng) @ np.array([[1, 0.3, 0.1], [0, 1, 0.2], [0, 0, 1]])
    dense, sparse = body[: 3 * COUNT // 4], body[3 * COUNT // 4 :]
    step = _translation(4, 1, 0)
    return Scene(np.vstack([dense, sparse + step[:3, 3]]), [(step, np.zeros(3))])


def _mirrored_ball(count: int, rng: np.random.Generator) -> Points:
    directions = rng.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    waves = 2 * rng.normal(size=(3, 8))
    radii = np.exp(0.12 * np.cos(np.abs(directions) * [1, 0, 0] @ waves
                                 + directions * [0, 1, 1] @ waves).sum(axis=1))  # fmt: skip
    return directions * radii[:, None]


def _reflection() -> Matrix:
    return np.diag([-1.0, 1, 1, 1])


def _translation(x: float, y: float, z: float) -> Matrix:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


SCENES = {
    "facade": facade,
    "chair": chair,
    "two symmetric objects": two_objects,
    "twins of uneven density": uneven_twins,
}
