"""The point groups of 56 parts of 33 groups: as meshes, as few points, and with noise."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

import symsurf

from .case import Case, Figures, at_least, at_most
from .poses import random_rotation
from .solids import sampled
from .symmetric_parts import (
    PARTS,
    Array,
    box,
    extruded,
    gear,
    noisy,
    polygon,
    propeller,
    rotation_about,
    turned,
)

COUNT = 3000  # points
PHI = (1 + 5**0.5) / 2


def reflection(normal: Sequence[float]) -> Array:
    unit = np.asarray(normal) / np.linalg.norm(normal)
    return np.eye(3) - 2 * np.outer(unit, unit)


TURN = {n: rotation_about((0, 0, 1), 2 * np.pi / n) for n in range(1, 11)}
HALF = rotation_about((1, 0, 0), np.pi)  # across the main axis
ACROSS, ALONG = reflection((0, 0, 1)), reflection((1, 0, 0))
DIAGONAL = rotation_about((1, 1, 1), 2 * np.pi / 3)  # of a cube
FIVEFOLD = rotation_about((0, 1, PHI), 2 * np.pi / 5)
TETRAHEDRAL, OCTAHEDRAL, ICOSAHEDRAL = ((turn, DIAGONAL) for turn in (TURN[2], TURN[4], FIVEFOLD))

GENERATORS: dict[str, Sequence[Array]] = {
    **{f"C{n}": (TURN[n],) for n in (1, 2, 3, 4, 5, 6)},
    **{f"C{n}v": (TURN[n], ALONG) for n in (2, 3, 4, 6)},
    **{f"C{n}h": (TURN[n], ACROSS) for n in (2, 3, 4)},
    **{f"D{n}": (TURN[n], HALF) for n in (2, 3, 4, 6)},
    **{f"D{n}h": (TURN[n], HALF, ACROSS) for n in (2, 3, 4)},
    **{f"D{n}d": (TURN[2 * n] @ ACROSS, HALF) for n in (2, 3)},
    "Cs": (ACROSS,),
    "Ci": (-np.eye(3),),
    "S4": (TURN[4] @ ACROSS,),
    "S6": (TURN[6] @ ACROSS,),
    "T": TETRAHEDRAL,
    "Td": (*TETRAHEDRAL, reflection((1, -1, 0))),
    "Th": (*TETRAHEDRAL, -np.eye(3)),
    "O": OCTAHEDRAL,
    "Oh": (*OCTAHEDRAL, -np.eye(3)),
    "I": ICOSAHEDRAL,
    "Ih": (*ICOSAHEDRAL, -np.eye(3)),
}


def elements(generators: Sequence[Array]) -> list[Array]:
    """All products of the matrices."""
    found = [np.eye(3)]
    for element in found:  # which grows
        for generator in generators:
            product = generator @ element
            if not any(np.allclose(product, other) for other in found):
                found.append(product)
    return found


def studded(group: str) -> Array:
    """A ball with a leaning stud at a position in general and at all its images."""
    maps = elements(GENERATORS[group])
    size = min(1.2, 3.2 / len(maps) ** 0.5)
    foot = size * np.array([(-0.2, -0.2, -0.3), (0.45, -0.2, -0.3), (-0.2, 0.25, -0.3)])
    tip = size * np.array([0.3, 0.15, 0.55])
    corners = np.vstack([foot, tip])
    stud = corners[[(0, 1, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3)]]
    stud = stud @ rotation_about((1, 2, 0.5), 1.1).T
    outward = np.array([0.35, 0.16, 0.92]) if len(maps) > 12 else np.array([0.7, 0.35, 0.6])
    stud = stud + 1.05 * outward / np.linalg.norm(outward)
    angle = np.linspace(0, np.pi, 19)
    ball = turned(np.sin(angle).tolist(), np.cos(angle).tolist(), steps=36)
    return np.concatenate([ball, *(stud @ each.T for each in maps)])


def hull(corners: Sequence[Sequence[float]]) -> Array:
    """The faces of a convex body without more than three corners in a plane."""
    from scipy.spatial import ConvexHull

    return np.asarray(corners, float)[ConvexHull(np.asarray(corners, float)).simplices]


def icosahedron() -> Array:
    return hull([np.roll((0, a, b * PHI), k) for a in (-1, 1) for b in (-1, 1) for k in range(3)])


def octahedron() -> Array:
    return hull([np.roll((a, 0, 0), k) for a in (-1, 1) for k in range(3)])


def helical_gear(teeth: int) -> Array:
    """Its teeth wind up by half their pitch."""
    flat = gear(teeth) * (1, 1, 2)
    angle = np.pi / teeth * flat[..., 2] / 0.3
    x, y, z = np.moveaxis(flat, -1, 0)
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack([cosine * x - sine * y, sine * x + cosine * y, z], axis=-1)


def spinner(blades: int) -> Array:
    """A propeller whose hub is a cylinder, but for a cone of a twentieth of its area at one end."""
    blade = box(0.9, 0.3, 0.06) @ rotation_about((1, 0, 0), 0.5).T + (0.6, 0, 0)
    hub = turned([0, 0.2, 0.2, 0], [-0.2, -0.2, 0.2, 0.45])
    maps = elements([TURN[blades]])
    return np.concatenate([hub, *(blade @ each.T for each in maps)])


def keyed(teeth: int) -> Array:
    """A gear with a key in its bore, below the middle of a tooth or of a gap."""
    turn = rotation_about((0, 0, 1), -0.15 * 2 * np.pi / teeth)
    return np.concatenate([gear(teeth) @ turn.T, box(0.12, 0.25, 0.3) + (0, 0.275, 0)])


MORE: dict[str, tuple[str, Array]] = {
    "icosahedron": ("Ih", icosahedron()),
    "octahedron": ("Oh", octahedron()),
    "pentagonal prism": ("D5h", extruded(polygon(5), 1.2)),
    "square pyramid": ("C4v", hull([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1.2)])),
    "helical gear of 9": ("D9", helical_gear(9)),
    "propeller of 4": ("C4", propeller(4)),
    "propeller of 3 with a spinner": ("C3", spinner(3)),
    "keyed gear of 12": ("C2v", keyed(12)),
}
SHAPES: dict[str, tuple[str, Array]] = {
    **{f"studs {group}": (group, studded(group)) for group in GENERATORS},
    **{name: (part.group, part.triangles) for name, part in PARTS.items()},
    **MORE,
}


def _trial(name: str, rng: np.random.Generator, kind: str) -> Figures:
    group, triangles = SHAPES[name]
    rotation, shift = 3 * random_rotation(rng).T, rng.normal(size=3)
    if kind == "mesh":
        corners, inverse = np.unique(triangles.reshape(-1, 3).round(9), axis=0, return_inverse=True)
        given = symsurf.Shape(corners @ rotation + shift, inverse.reshape(-1, 3))
    else:
        corners = triangles.reshape(-1, 3)
        faces = np.arange(len(corners)).reshape(-1, 3)
        given = sampled(corners, faces, COUNT, rng) @ rotation + shift
        if kind == "noise":
            given = noisy(given, 0.005, rng)
    start = time.process_time()
    found = symsurf.symmetries(given, threads=1)
    seconds = time.process_time() - start
    return {"named": float(found.group == group), "seconds": seconds}


CASES = tuple(
    Case(
        title,
        tuple(SHAPES),
        lambda name, rng, kind=kind: _trial(name, rng, kind),
        {"named": at_least(right), "seconds": at_most(1)},
        trials=10,
    )
    for kind, title, right in (
        ("mesh", "point groups: meshes", 0.98),
        ("points", "point groups: 3000 points", 0.98),
        ("noise", "point groups: noise 0.5 %", 0.95),
    )
)
