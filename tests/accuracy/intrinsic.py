"""Posed bodies whose truth is known by index: geodesic errors of their intrinsic symmetry."""

from __future__ import annotations

import time

import numpy as np

import symsurf

from .case import Case, Figures, at_least, at_most
from .geodesics import geodesic_distances
from .limbed import BODIES
from .mesh_limbs import JOINTS, mesh_body
from .poses import random_rotation
from .posing import posed

CHECKED = 100  # points whose error is measured
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
)
