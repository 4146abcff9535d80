"""Random shapes without a mirror: of boxes, of a handed form, sheets that something stands on."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .pieces import Mesh, box, joined, loft
from .poses import Points
from .solids import ASYMMETRIC, asymmetric, sampled
from .without_mirror import handed

Rng = np.random.Generator


def _room(rng: Rng) -> Mesh:
    """A floor, two walls of unlike sizes that meet, and boxes that stand on the floor."""
    wide, long, high = rng.uniform((3, 5, 2), (4.5, 7, 3))
    pieces = [
        box((wide / 2, long / 2, -0.05), (wide, long, 0.1)),
        box((-0.05, long / 2, high / 2), (0.1, long, high)),
        box((wide / 2, -0.05, high / 2), (wide, 0.1, high)),
    ]
    for _ in range(rng.integers(3, 13)):
        size = rng.uniform(0.3, 1.6, size=3)
        x, y = rng.uniform(size[:2] / 2, np.array([wide, long]) - size[:2] / 2)
        pieces.append(box((x, y, size[2] / 2), size))
    return joined(pieces)


def _tops(rng: Rng) -> Mesh:
    """A polygon of five random corners, and three boxes on it."""
    angle = np.sort(2 * np.pi * (np.arange(5) + rng.uniform(-0.35, 0.35, size=5)) / 5)
    corners = rng.uniform(0.6, 1.1, size=(5, 1)) * np.column_stack([np.cos(angle), np.sin(angle)])
    rim = np.column_stack([corners, np.zeros(5)])
    fan = np.column_stack([np.arange(5), np.roll(np.arange(5), -1), np.full(5, 5)])
    pieces: list[Mesh] = [(np.vstack([rim, np.zeros(3)]), fan)]
    for _ in range(3):
        x, y = (rng.dirichlet(np.ones(5)) @ corners) * 0.9
        size = rng.uniform(0.1, 0.4, size=3)
        c, s = np.cos(turn := rng.uniform(0, np.pi)), np.sin(turn)
        points, faces = box((0, 0, size[2] / 2), size)
        pieces.append((points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + (x, y, 0), faces))
    return joined(pieces)


def _helix(rng: Rng, sides: int = 24) -> Mesh:
    """A spring of a scalene section. A round one has a mirror: the cylinder that its path is on."""
    turns, rise, thick = rng.uniform((1.5, 0.6, 0.2), (4, 1.4, 0.35))
    angle = np.linspace(0, 2 * np.pi * turns, round(40 * turns))
    slope = rise / (2 * np.pi)
    cos, sin, none = np.cos(angle), np.sin(angle), 0 * angle
    path = np.column_stack([cos, sin, slope * angle])
    outward = np.column_stack([cos, sin, none])
    across = np.column_stack([slope * sin, -slope * cos, none + 1]) / np.hypot(1, slope)
    section = thick * np.array([(-0.9, -0.5), (1.0, -0.7), (-0.3, 1.0)])
    return loft(
        path[:, None] + section[:, :1] * outward[:, None] + section[:, 1:] * across[:, None]
    )


def _tetracube(rng: Rng) -> Mesh:
    """Four cubes in a screw, or blocks of other steps along each axis."""
    cells = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1)])
    quads = []
    for cell in cells:
        for axis in range(3):
            for side in (0, 1):
                beside = cell + (2 * side - 1) * np.eye(3, dtype=int)[axis]
                if (cells == beside).all(axis=1).any():
                    continue
                square = np.insert([(0, 0), (1, 0), (1, 1), (0, 1)], axis, side, axis=1)
                quads.append(cell + square)
    spread = rng.choice([0, 0.2])
    corners = np.vstack(quads) * rng.uniform(1 - spread, 1 + spread, size=3)
    first = 4 * np.arange(len(quads))[:, None]
    return corners, np.vstack([first + [0, 1, 2], first + [0, 2, 3]])


def _screw(rng: Rng, sides: int = 48) -> Mesh:
    """A round shaft with a thread, and a head."""
    pitch, depth, length = rng.uniform((0.5, 0.15, 3), (1.0, 0.3, 5))
    angle = 2 * np.pi * np.arange(sides) / sides
    heights = np.linspace(0, length, round(16 * length / pitch))
    rounds = heights[:, None] / pitch + angle / (2 * np.pi)
    radius = 1 - 2 * depth * np.abs(rounds % 1 - 0.5)
    head, rise = rng.uniform((1.5, 0.5), (2.2, 1.2))
    radius = np.vstack([radius, np.full((2, sides), head)])
    heights = np.append(heights, [length, length + rise])
    return loft(
        np.stack(
            [radius * np.cos(angle), radius * np.sin(angle),
             np.broadcast_to(heights[:, None], radius.shape)],
            axis=-1,
        )
    )  # fmt: skip


def _terrain(count: int, rng: Rng) -> Points:
    """A square tile, whose waves are the lower the shorter they are."""
    places = rng.uniform(-0.5, 0.5, size=(count, 2))
    number = np.exp(rng.uniform(np.log(0.7), np.log(12), size=40))
    way = rng.uniform(0, 2 * np.pi, size=40)
    waves = 2 * np.pi * number[:, None] * np.column_stack([np.cos(way), np.sin(way)])
    strength = rng.normal(size=40) / number ** rng.uniform(0.8, 1.3)
    height = np.cos(places @ waves.T + rng.uniform(0, 2 * np.pi, size=40)) @ strength
    return np.column_stack([places, rng.uniform(0.03, 0.08) * height / height.std()])


def _half_blob(count: int, rng: Rng) -> Points:
    """A bumpy ball without a mirror, cut through its middle and open there."""
    points = asymmetric("bumpy", 4 * count, rng)
    return points[points @ rng.normal(size=3) > 0][:count]


MESHES: dict[str, Callable[[Rng], Mesh]] = {
    "room": _room,
    "table top": _tops,
    "helix": _helix,
    "tetracube": _tetracube,
    "screw": _screw,
}

HANDED = ("helical gear", "propeller", "screw")
BODIES = (*ASYMMETRIC, "half blob", "helix", "tetracube")


def mirrorless(subject: str, count: int, rng: Rng) -> NDArray[np.float64]:
    """So many points of one of the BODIES, HANDED, or of a "room", "table top" or "terrain"."""
    if subject in MESHES:
        return sampled(*MESHES[subject](rng), count, rng)
    if subject == "terrain":
        return _terrain(count, rng)
    if subject == "half blob":
        return _half_blob(count, rng)
    return handed(subject, count, rng) if subject in HANDED else asymmetric(subject, count, rng)
