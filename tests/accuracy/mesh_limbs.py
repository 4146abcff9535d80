"""Meshes of others whose vertices know their mirror images, and where their limbs bend."""

from __future__ import annotations

from functools import cache

import numpy as np

from .posing import Body, Joint, Triple
from .solids import mirrored_mesh

FAR = np.inf


def _both(at: Triple, axis: Triple, length: float, low: Triple, high: Triple,
          hinge: Triple | None = None) -> list[Joint]:  # fmt: skip
    """The joint of a limb where x > 0, and that of its image."""

    def other(way: Triple) -> Triple:
        return (-way[0], way[1], way[2])

    image = (-high[0], *low[1:]), (-low[0], *high[1:])
    return [
        Joint(at, axis, length, low, high, hinge),
        Joint(other(at), other(axis), length, *image, hinge),
    ]


JOINTS = {
    "cow": [
        *_both((0.2, -0.4, 0.1), (0, -1, 0), 0.3, (0, -FAR, -0.2), (FAR, -0.4, 0.34)),
        *_both((0.2, -0.4, 0.65), (0, -1, 0), 0.3, (0, -FAR, 0.34), (FAR, -0.4, 1)),
        Joint((0, 0.25, -0.05), (0, 0.6, -0.8), 0.3),
    ],
    "fox": [
        *_both((5, -27, 28), (0, 0, -1), 18, (0, -45, -FAR), (FAR, -12, 28)),
        *_both((6, 4, 22), (0, 0, -1), 14, (0, -12, -FAR), (FAR, 20, 22)),
        Joint((0, 22, 22), (0, 1, 0), 20, (-FAR, 22, -FAR), (FAR, FAR, FAR)),
    ],
    "face": _both((25, 0, -50), (1, 0, 0), 40, (25, -FAR, -FAR), (FAR, FAR, FAR), (0, 1, 0)),
    "airplane": [
        *_both((90, 580, 40), (1, 0, 0), 300, (90, 300, -FAR), (FAR, 800, FAR), (0, 1, 0)),
        *_both((18, 1200, 158), (1, 0, 0), 80, (18, 1100, 130), (FAR, FAR, 175), (0, 1, 0)),
    ],
}


@cache
def mesh_body(name: str) -> Body:
    """Its plane of symmetry is x = 0."""
    points, faces, plane = mirrored_mesh(name)
    points = points + [plane.offset, 0, 0]
    away = np.linalg.norm(points * [-1, 1, 1] - points[:, None], axis=2)
    return Body(points, faces, away.argmin(axis=0), JOINTS[name])
