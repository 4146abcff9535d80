"""Posed bodies whose truth is known by index: geodesic errors of their intrinsic symmetry."""

from __future__ import annotations

import time

import numpy as np
from scipy.spatial import cKDTree

import symsurf

from .case import Case, Figures, at_least, at_most
from .geodesics import geodesic_distances
from .limbed import BODIES
from .mesh_limbs import JOINTS, mesh_body
from .poses import random_rotation
from .posing import Body, posed

CHECKED = 100  # points whose error is measured
SCANNED = 30_000  # points of a scan, those missing included
HOLES = 5
ANGLE = 0.9  # radians, at most, of a joint


def _trial(name: str, rng: np.random.Generator, as_cloud: bool) -> Figures:
    body = BODIES[name] if name in BODIES else mesh_body(name)
    points = posed(body, rng, ANGLE) @ random_rotation(rng).T
    start = time.process_time()
    found = symsurf.intrinsic_symmetry(points, faces=None if as_cloud else body.faces, threads=1)
    seconds = time.process_time() - start
    checked = rng.choice(len(points), CHECKED, replace=False)
    away = geodesic_distances(body, points, body.mirrored[checked])
    images = found.image[checked]
    errors = np.where(images >= 0, away[np.arange(CHECKED), images], np.inf)
    identity = away[np.arange(CHECKED), checked]
    return {
        "geodesic error": float(np.mean(errors) / away.max()),
        "no flip": float(np.mean(errors) < 0.5 * np.mean(identity)),
        "found": float(found.verdict == "found"),
        "seconds": seconds,
    }


def incomplete_scan(
    body: Body, points: np.ndarray, missing: float, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random points of the posed surface without those of HOLES holes, the vertex nearest to each,
    and where its counterpart is."""
    corners = points[body.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    faces = rng.choice(len(areas), SCANNED, p=areas / areas.sum())
    weights = rng.dirichlet((1, 1, 1), SCANNED)
    scan = (corners[faces] * weights[:, :, None]).sum(axis=1)
    there = (points[body.mirrored[body.faces[faces]]] * weights[:, :, None]).sum(axis=1)
    vertices = body.faces[faces, weights.argmax(axis=1)]
    kept = np.ones(SCANNED, bool)
    for _ in range(HOLES):
        middle = scan[rng.choice(np.flatnonzero(kept))]
        away = np.where(kept, np.linalg.norm(scan - middle, axis=1), np.inf)
        kept[np.argsort(away)[: round(missing * SCANNED / HOLES)]] = False
    return scan[kept], vertices[kept], there[kept]


def _scan_trial(name: str, rng: np.random.Generator, missing: float) -> Figures:
    """Distances are straight where an image lies on the right limb: finer than vertices are."""
    body = BODIES[name] if name in BODIES else mesh_body(name)
    points = posed(body, rng, ANGLE) @ random_rotation(rng).T
    scan, vertices, there = incomplete_scan(body, points, missing, rng)
    start = time.process_time()
    found = symsurf.intrinsic_symmetry(scan, threads=1)
    seconds = time.process_time() - start
    checked = rng.choice(len(scan), CHECKED, replace=False)
    away = geodesic_distances(body, points, body.mirrored[vertices[checked]])
    longest = away[np.isfinite(away)].max()
    images = found.image[checked]
    nearest = cKDTree(points).query(scan[images])[1]
    errors = away[np.arange(CHECKED), nearest]
    straight = np.linalg.norm(scan[images] - there[checked], axis=1)
    errors = np.where(errors < 0.1 * longest, straight, np.minimum(errors, longest))
    errors[images < 0] = longest
    identity = away[np.arange(CHECKED), vertices[checked]]
    flipped = found.verdict == "found" and np.mean(errors) >= 0.5 * np.mean(identity)
    return {
        "geodesic error": float(np.mean(errors) / longest),
        "no flip": float(not flipped),
        "found": float(found.verdict == "found"),
        "seconds": seconds,
    }


BARS = {"geodesic error": at_most(0.03), "no flip": at_least(1)}
CASES = tuple(
    Case(
        f"intrinsic: posed {'clouds' if as_cloud else 'meshes'}",
        (*BODIES, *JOINTS),
        lambda name, rng, as_cloud=as_cloud: _trial(name, rng, as_cloud),
        BARS,
        trials=20,
    )
    for as_cloud in (False, True)
) + tuple(
    Case(
        f"neighbours, intrinsic: Jiang, {title}",
        (*BODIES, *JOINTS),
        lambda name, rng, missing=missing: _scan_trial(name, rng, missing),
        {"geodesic error": at_most(bar), "no flip": at_least(1)},
        trials=10,
    )
    # What lies opposite to a hole has its image at the rim: on average a third of a hole away.
    for title, missing, bar in (("scans of poses", 0, 0.03), ("a tenth missing", 0.1, 0.05))
)
