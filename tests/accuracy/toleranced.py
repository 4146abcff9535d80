"""Symmetric bodies with pins, dents and labels: what is left within what pose benchmarks accept. And how
far elements deviate that hold within a tolerance."""

from __future__ import annotations

import itertools
import time

import numpy as np

import symsurf

from .case import Case, Figures, at_least, at_most
from .poses import random_rotation
from .solids import sampled
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


KINDS = ("prism", "box", "rings", "studs")


def _nearly_symmetric(kind: str, rng: np.random.Generator) -> tuple[symsurf.Shape, float]:
    """A convex part with a corner moved, a corner added, or stretched, by 0.01 to 10 % of its diagonal,
    which is given, too."""
    import trimesh

    turn = 2 * np.pi * np.arange(rng.integers(3, 9))
    turn /= len(turn)
    ring = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    height = rng.uniform(0.3, 2) * np.array((0, 0, 1))
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    points = {
        "prism": np.vstack([ring - height / 2, rng.choice([1, 0.7]) * ring + height / 2]),
        "box": corners * rng.choice([1, rng.uniform(0.4, 1)], 3),
        "rings": np.vstack([ring - height / 2, 0.6 * ring + height, 1.1 * ring]),
        "studs": np.vstack([corners, 1.6 * np.eye(3), -1.6 * np.eye(3)]),
    }[kind]
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    change = 10 ** rng.uniform(-4, -1)
    what = rng.integers(3)
    if what == 0:
        points[rng.integers(len(points))] *= 1 + 2 * change
    elif what == 1:
        way = rng.normal(size=3)
        end = np.abs(points).max() + change * diagonal
        points = np.vstack([points, points.mean(axis=0) + end * way / np.linalg.norm(way)])
    else:
        points *= 1 + change * rng.choice([0, 1], 3)
    hull = trimesh.convex.convex_hull(points @ random_rotation(rng).T + rng.normal(size=3))
    hull = hull.subdivide() if rng.random() < 0.5 else hull
    return symsurf.Shape(np.array(hull.vertices), np.array(hull.faces)), diagonal


def _greatest_deviation(kind: str, rng: np.random.Generator) -> Figures:
    """Of vertices and 1500 points of the faces under every element from the surface, in tolerances, by
    VTK's closest points."""
    shape, diagonal = _nearly_symmetric(kind, rng)
    tolerance = 10 ** rng.uniform(-3.5, -1) * diagonal
    start = time.process_time()
    found = symsurf.symmetries(shape, tolerance=tolerance, threads=1)
    seconds = time.process_time() - start
    points = np.vstack([shape.points, sampled(shape.points, shape.faces, 1500, rng)])
    mesh, worst = shape.to_pyvista(), 0.0
    for element in found.elements:
        images = points @ element[:3, :3].T + element[:3, 3]
        _, closest = mesh.find_closest_cell(images, return_closest_point=True)
        worst = max(worst, float(np.linalg.norm(closest - images, axis=1).max()))
    return {"deviation": worst / tolerance, "seconds": seconds}


CASES = (
    Case(
        "symmetries: pins and labels",
        tuple(BODIES),
        _trial,
        {"named": at_least(1), "seconds": at_most(1)},
        trials=4,
    ),
    Case(
        "symmetries: deviations within the tolerance",
        KINDS,
        _greatest_deviation,
        {"deviation": at_most(1.001)},
        trials=125,
    ),
)
