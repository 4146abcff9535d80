"""Symmetric bodies with pins, dents and labels: what is left within what pose benchmarks accept."""

from __future__ import annotations

import time

import numpy as np

import symsurf

from .case import Case, Figures, at_least, at_most
from .poses import random_rotation
from .symmetric_parts import PARTS, Array, box, extruded, gear, polygon, rotation_about, turned

# Under the rule "object": a hexagonal head on a long shaft is within 5 % of the diameter, a handle of a
# tenth of the area and more is none of a label's size.
CUP = turned([0, 0.4, 0.5, 0.45, 0.35, 0], [-0.6, -0.6, 0.6, 0.6, -0.5, -0.5], steps=72)
MUG = np.concatenate([CUP, box(0.5, 0.12, 0.7) + (0.65, 0, 0)])
BODIES: dict[str, tuple[str, Array]] = {
    "box": ("D2h", box(2, 1.4, 0.9)),
    "cube": ("Oh", box(1, 1, 1)),
    "square prism": ("D4h", extruded(polygon(4), 1.9)),
    "triangular prism": ("D3h", extruded(polygon(3), 1.6)),
    "can": ("D∞h", turned([0, 0.5, 0.5, 0], [-0.8, -0.8, 0.8, 0.8], steps=64)),
    "bottle": ("C∞v", turned([0, 0.4, 0.4, 0.15, 0.15, 0], [-1, -1, 0.3, 0.6, 1, 1], steps=64)),
    "cup": ("C∞v", CUP),
    "bowl": ("C∞v", turned([0, 0.4, 0.8, 0.7, 0.3, 0], [0, 0, 0.5, 0.5, 0.1, 0.1], steps=60)),
    "mug": ("Cs", MUG),
    "bolt": (
        "C∞v",
        np.concatenate(
            [
                extruded(0.3 * polygon(6), 0.25) + (0, 0, 1.1),
                turned([0, 0.15, 0.15, 0], [-1, -1, 1, 1], steps=48),
            ]
        ),
    ),
    "gear of 7": ("D7h", gear(7)),
    "bracket": ("Cs", PARTS["bracket"].triangles),
    "asymmetric part": ("C1", PARTS["asymmetric part"].triangles),
}


def spoilt(triangles: Array, rng: np.random.Generator) -> Array:
    """With a pin, dent or label, 1 to 8 % of the diameter wide, at three random places, together less
    than 3 % of the area."""
    corners = triangles.reshape(-1, 3)
    diameter = np.linalg.norm(np.ptp(corners, axis=0))
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    areas = np.linalg.norm(normals, axis=1) / 2
    parts = [triangles]
    for width, height in ((0.02, 0.06), (0.04, 0.02), (0.08, 0.01)):
        size = diameter * np.array([width, width, height]) * rng.uniform(0.5, 1)
        face = rng.choice(len(areas), p=areas / areas.sum())
        weights = rng.dirichlet((2, 2, 2))
        z = normals[face] / np.linalg.norm(normals[face])
        x = np.cross(z, np.roll(z, 1) + (0.1, 0.2, 0.3))
        x /= np.linalg.norm(x)
        parts.append(box(*size) @ np.array([x, np.cross(z, x), z]) + weights @ triangles[face])
    return np.concatenate(parts)


def posed(triangles: Array, rng: np.random.Generator) -> symsurf.Shape:
    corners, inverse = np.unique(triangles.reshape(-1, 3).round(9), axis=0, return_inverse=True)
    turn = random_rotation(rng) @ rotation_about((0, 0, 1), 1)
    return symsurf.Shape(corners @ turn * 100 + rng.normal(size=3), inverse.reshape(-1, 3))


def _trial(name: str, rng: np.random.Generator) -> Figures:
    group, triangles = BODIES[name]
    shape = posed(spoilt(triangles, rng), rng)
    start = time.process_time()
    found = symsurf.symmetries(shape, tolerance_rule="object", threads=1)
    seconds = time.process_time() - start
    return {"named": float(found.group == group), "seconds": seconds}


CASES = (
    Case(
        "symmetries: pins and labels",
        tuple(BODIES),
        _trial,
        {"named": at_least(1), "seconds": at_most(1)},
        trials=4,
    ),
)
