"""Symmetric bodies that know which vertex mirrors which, and their poses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .poses import Points

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Joint:
    """What lies beyond a point along an axis, in a box of the standing body, bends."""

    at: Triple
    axis: Triple
    length: float
    """Of the arc."""
    low: Triple = (-np.inf, -np.inf, -np.inf)
    high: Triple = (np.inf, np.inf, np.inf)
    hinge: Triple | None = None
    """What it bends about, square to the axis; without it about any."""


@dataclass
class Body:
    points: Points
    faces: NDArray[np.int64]
    mirrored: NDArray[np.int64]
    """Of each vertex the one on its other side."""
    joints: list[Joint]

    @cached_property
    def edges(self) -> NDArray[np.int64]:
        """(n, 2): each both ways."""
        faces = self.faces
        edges = np.vstack([faces[:, [a, b]] for a in range(3) for b in range(3) if a != b])
        return np.unique(edges, axis=0)


def posed(body: Body, rng: np.random.Generator, angle: float) -> Points:
    """Each joint bent into an arc to somewhere, by a third of the angle to all of it."""
    points = body.points.copy()
    for joint in body.joints:
        inside = ((body.points >= joint.low) & (body.points <= joint.high)).all(axis=1)
        axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
        about = np.cross(axis, rng.normal(size=3))
        if joint.hinge:
            about = np.sign(about @ joint.hinge) * np.array(joint.hinge)
        about /= np.linalg.norm(about)
        bend = rng.uniform(angle / 3, angle)
        moved = _bent(body.points[inside], np.array(joint.at), axis, about, bend, joint.length)
        points[inside] = moved
    return points


def _bent(
    points: Points, at: Points, axis: Points, about: Points, angle: float, length: float
) -> Points:
    side = np.cross(about, axis)
    x = points - at
    along = np.maximum(x @ axis, 0)
    behind = np.minimum(x @ axis, 0)
    on_arc = np.minimum(along, length)
    turned, radius = (angle * on_arc / length)[:, None], length / angle
    middle = at + radius * (np.sin(turned) * axis + (1 - np.cos(turned)) * side)
    ahead = np.cos(turned) * axis + np.sin(turned) * side
    inward = np.cos(turned) * side - np.sin(turned) * axis
    return (
        middle
        + (along - on_arc + behind)[:, None] * ahead
        + (x @ side)[:, None] * inward
        + (x @ about)[:, None] * about
    )
