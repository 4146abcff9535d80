"""``auto`` and ``plane`` where there is no mirror: the verdict is "none"."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .case import Case, Figures, at_least, timed_detect
from .damage import noise
from .pieces import Mesh, gear_outline, joined, loft, tube
from .poses import Points, random_rotation
from .solids import asymmetric, filled, sampled

Draw = Callable[[str, int, np.random.Generator], Points]
SIZES = (1000, 2000, 4000)


def plain(cloud: str, count: int, rng: np.random.Generator) -> Points:
    """Independent points, whose distribution alone is its own image: no point has a partner."""
    sides = rng.uniform(0.3, 1, size=3)
    if cloud == "Gaussian":
        return rng.normal(size=(count, 3)) * sides
    return rng.uniform(-1, 1, size=(count, 3)) * sides


def handed(body: str, count: int, rng: np.random.Generator) -> Points:
    """Of a body that has a left and a right form; it may have rotations."""
    mesh = _helical_gear(rng) if body == "helical gear" else _propeller(rng)
    return sampled(*mesh, count, rng)


def _helical_gear(rng: np.random.Generator) -> Mesh:
    teeth, pitches = int(rng.integers(8, 21)), rng.uniform(0.5, 1)
    outline = gear_outline(teeth, rng.uniform(0.15, 0.3))
    turns = np.linspace(0, 2 * np.pi * pitches / teeth, 9)
    rings = []
    for angle, height in zip(turns, np.linspace(0, rng.uniform(0.3, 1), 9)):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        rings.append(np.column_stack([outline @ turn, np.full(len(outline), height)]))
    return loft(rings)


def _propeller(rng: np.random.Generator) -> Mesh:
    blades, hub = int(rng.integers(2, 6)), rng.uniform(0.1, 0.2)
    pitch = np.radians(np.linspace(rng.uniform(40, 60), rng.uniform(15, 30), 9))
    chord = rng.uniform(0.15, 0.3) * np.linspace(1, rng.uniform(0.5, 1), 9)
    flat = np.array([[-0.5, 0], [0, 0.05], [0.5, 0], [0, -0.05]])
    rings = []
    for reach, angle, wide in zip(np.linspace(0.5 * hub, 1, 9), pitch, chord):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        rings.append(np.column_stack([np.full(4, reach), wide * flat @ turn]))
    points, faces = loft(rings)
    pieces = [tube([(0, 0, -hub), (0, 0, hub)], hub, 24)]
    for angle in 2 * np.pi * np.arange(blades) / blades:
        c, s = np.cos(angle), np.sin(angle)
        pieces.append((points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]), faces))
    return joined(pieces)


def _case(
    method: str, name: str, subjects: tuple[str, ...], draw: Draw, share: float, trials: int
) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        points = draw(subject, int(rng.choice(SIZES)), rng) @ random_rotation(rng).T
        result, seconds = timed_detect(noise(points, share, rng), method)
        verdict = float(result.statistics["verdict"] == "none")
        return {"verdict none": verdict, "score": result.score, "seconds": seconds}

    damage = "noise 1 %" if share else "clean"
    bar = at_least(0.93 if share else 0.97)
    return Case(f"{method}, none: {name}, {damage}", subjects, run, {"verdict none": bar}, trials)


GROUPS: tuple[tuple[str, tuple[str, ...], Draw, int], ...] = (
    ("solids", ("bumpy", "lumps", "facets"), asymmetric, 70),
    ("open sheets", ("sheet",), asymmetric, 100),
    ("volumes", ("bumpy", "facets"), filled, 100),
    ("plain clouds", ("uniform", "Gaussian"), plain, 50),
    ("handed bodies", ("helical gear", "propeller"), handed, 20),
)

CASES = tuple(
    _case(method, name, subjects, draw, share, trials)
    for method in ("auto", "plane")
    for name, subjects, draw, trials in GROUPS
    for share in (0, 0.01)
)
