"""Pairs of vertices by the triangles alone, of posed bodies with symmetric triangulations."""

from __future__ import annotations

import time
from functools import cache

import numpy as np
from numpy.typing import NDArray

import symsurf

from .case import Case, Figures, at_least, at_most
from .limbed import BODIES
from .mesh_limbs import JOINTS, mesh_body
from .poses import Points
from .posing import Body, posed

ANGLES = 17, 29, 57, 86
"""Degrees that each joint bends by at the most, in turns."""


def symmetric_faces(body: Body) -> NDArray[np.int64]:
    """The triangles of the side x >= 0, and those of the vertices that mirror theirs; none of vertices
    that are not each other's."""
    own, over = np.arange(len(body.mirrored)), body.mirrored
    is_positive = ((body.points[:, 0] > 0) | (over == own)) & (over[over] == own)
    half = body.faces[is_positive[body.faces].all(axis=1) & ~(over == own)[body.faces].all(axis=1)]
    return np.vstack([half, over[half][:, ::-1]])


@cache
def _body(name: str) -> Body:
    body = BODIES[name] if name in BODIES else mesh_body(name)
    return Body(body.points, symmetric_faces(body), body.mirrored, body.joints)


def pose(body: Body, rng: np.random.Generator, seed: int) -> Points:
    return posed(body, rng, np.radians(ANGLES[seed % len(ANGLES)]))


def _paired(subject: str, rng: np.random.Generator) -> Figures:
    body = _body(subject)
    points = pose(body, rng, int(rng.integers(len(ANGLES))))
    order = rng.permutation(len(points))  # indices tell nothing
    place = np.argsort(order)
    shape = symsurf.Shape(points[order], place[body.faces])
    used = np.unique(shape.faces)
    start = time.process_time()
    found = symsurf.correspondences(shape, "x=0", pairing="topology", threads=1)
    seconds = time.process_time() - start
    truth = place[body.mirrored[order]]
    return {"right": float((found.index == truth)[used].mean()), "seconds": seconds}


CASES = (
    Case("pairs by topology", (*BODIES, *JOINTS), _paired,
         {"right": at_least(1), "seconds": at_most(0.2)}, trials=10),
)  # fmt: skip
