"""The point groups of coloured objects, as clouds and as meshes."""

from __future__ import annotations

import time

import numpy as np

import symsurf

from .case import Case, Figures, at_least, at_most
from .coloured_parts import COLOURED_PARTS
from .poses import random_rotation
from .solids import sampled

COUNT = 20_000  # points
EDGE = 0.04  # of meshes, which are some 2 wide
NOISE = 0.03  # standard deviation of each channel, of their range


def _trial(name: str, rng: np.random.Generator, as_mesh: bool) -> Figures:
    part = COLOURED_PARTS[name]
    if as_mesh:
        points, faces, colours = part.mesh(EDGE)
    else:
        corners, faces = part.triangles.reshape(-1, 3), None
        points = sampled(corners, np.arange(len(corners)).reshape(-1, 3), COUNT, rng)
        colours = part.painted(points)
    colours = colours + rng.normal(scale=NOISE, size=colours.shape)
    points = 3 * points @ random_rotation(rng).T + rng.normal(size=3)
    start = time.process_time()
    found = symsurf.symmetries(points, faces=faces, colours=colours, texture=True, threads=1)
    return {
        "named": float(found.group == part.group),
        "seconds": time.process_time() - start,
    }


CASES = tuple(
    Case(
        f"symmetries: {kind} with colours",
        tuple(COLOURED_PARTS),
        lambda name, rng, as_mesh=as_mesh: _trial(name, rng, as_mesh),
        {"named": at_least(1), "seconds": at_most(5)},
        trials=5,
    )
    for kind, as_mesh in (("clouds", False), ("meshes", True))
)
