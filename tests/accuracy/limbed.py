"""Bodies of cubes with limbs, whose vertices know their mirror images, and their poses."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Box = tuple[tuple[int, int, int], tuple[int, int, int]]
Points = NDArray[np.float64]


@dataclass(frozen=True)
class Joint:
    """What lies beyond a point along an axis, in a box of the standing body, bends."""

    at: tuple[float, float, float]
    axis: tuple[float, float, float]
    length: float
    low: tuple[float, float, float]
    high: tuple[float, float, float]


@dataclass
class Body:
    """Boxes of cells of the side x >= 0; the other side mirrors them."""

    boxes: list[Box]
    joints: list[Joint]
    points: Points = field(init=False)
    faces: NDArray[np.int64] = field(init=False)
    mirrored: NDArray[np.int64] = field(init=False)
    neighbours: list[NDArray[np.int64]] = field(init=False)

    def __post_init__(self) -> None:
        full = _cells(self.boxes)
        vertices: dict[tuple[int, ...], int] = {}
        faces = []
        for cell in sorted(full):
            for axis in range(3):
                for side in (0, 1):
                    beside = list(cell)
                    beside[axis] += 2 * side - 1
                    if tuple(beside) in full:
                        continue
                    quad = []
                    for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        corner = list(cell)
                        corner[axis] += side
                        corner[(axis + 1) % 3] += u
                        corner[(axis + 2) % 3] += v
                        quad.append(vertices.setdefault(tuple(corner), len(vertices)))
                    if side == 0:
                        quad = [quad[0], quad[3], quad[2], quad[1]]
                    # Cut along either diagonal: no triangulation is mirrored as a whole.
                    k = int((cell[0] < 0) != (axis == 0))
                    faces += [
                        (quad[k], quad[(k + 1) % 4], quad[(k + 2) % 4]),
                        (quad[k], quad[(k + 2) % 4], quad[(k + 3) % 4]),
                    ]
        self.faces = np.array(faces)
        corners = np.array(list(vertices))
        self.mirrored = np.array([vertices[-x, y, z] for x, y, z in corners.tolist()])
        edges = np.vstack([self.faces[:, [a, b]] for a in range(3) for b in range(3) if a != b])
        edges = np.unique(edges, axis=0)
        self.neighbours = np.split(edges[:, 1], np.flatnonzero(np.diff(edges[:, 0])) + 1)
        points = corners.astype(float)
        for _ in range(3):
            means = np.array([points[around].mean(axis=0) for around in self.neighbours])
            points = (points + means) / 2
        self.points = points


def _cells(boxes: list[Box]) -> set[tuple[int, ...]]:
    cells = set()
    for low, high in boxes:
        for x, y, z in np.ndindex(*np.subtract(high, low)):
            at = (x + low[0], y + low[1], z + low[2])
            cells |= {at, (-1 - at[0], at[1], at[2])}
    return cells


def posed(body: Body, rng: np.random.Generator, angle: float) -> Points:
    """Each joint bent into an arc to somewhere, by a third of the angle to all of it."""
    points = body.points.copy()
    for joint in body.joints:
        inside = ((body.points >= joint.low) & (body.points <= joint.high)).all(axis=1)
        axis = np.array(joint.axis)
        about = np.cross(axis, rng.normal(size=3))
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


def _limb(x: float, y: float, top: float, length: float, width: float = 4) -> list[Joint]:
    return [
        Joint(
            (s * x, y, top),
            (0, 0, -1),
            length,
            (min(0.01 * s, 20 * s), y - width, -99),
            (max(0.01 * s, 20 * s), y + width, top),
        )
        for s in (1, -1)
    ]


BODIES = {
    "animal": Body(
        [
            ((0, 0, 0), (4, 20, 6)),
            ((0, 20, 4), (2, 24, 10)),
            ((0, 22, 8), (3, 30, 13)),
            ((0, -12, 3), (1, 0, 5)),
            ((1, 1, -16), (4, 4, 0)),
            ((1, 16, -14), (4, 19, 0)),
        ],
        [
            *_limb(2.5, 2.5, -3, 9),
            *_limb(2.5, 17.5, -3, 9),
            Joint((0, -2, 4), (0, -1, 0), 6, (-9, -99, -9), (9, -2, 9)),
        ],
    ),
    "person": Body(
        [
            ((0, 0, 0), (5, 5, 14)),
            ((0, 1, 14), (2, 4, 16)),
            ((0, 0, 16), (3, 6, 22)),
            ((5, 1, 11), (20, 4, 14)),
            ((1, 1, -20), (4, 4, 0)),
            ((1, 4, -20), (4, 7, -18)),
        ],
        [
            *_limb(2.5, 2.5, -4, 9, 6),
            *(
                Joint(
                    (s * 8, 2.5, 12.5),
                    (s, 0, 0),
                    8,
                    (min(8 * s, 99 * s), -9, 9),
                    (max(8 * s, 99 * s), 9, 16),
                )
                for s in (1, -1)
            ),
        ],
    ),
}
