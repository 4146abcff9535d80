"""Bodies of cubes with limbs, whose vertices know their mirror images."""

from __future__ import annotations

import numpy as np

from .posing import Body, Joint

Box = tuple[tuple[int, int, int], tuple[int, int, int]]


def _body(boxes: list[Box], joints: list[Joint]) -> Body:
    """Boxes of cells of the side x >= 0, which the other side mirrors, with smoothed corners."""
    full = _cells(boxes)
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
    corners = np.array(list(vertices))
    mirrored = np.array([vertices[-x, y, z] for x, y, z in corners.tolist()])
    body = Body(corners.astype(float), np.array(faces), mirrored, joints)
    start, end = body.edges.T
    degree = np.bincount(start)[:, None]
    for _ in range(3):
        sums = np.zeros_like(body.points)
        np.add.at(sums, start, body.points[end])
        body.points = (body.points + sums / degree) / 2
    return body


def _cells(boxes: list[Box]) -> set[tuple[int, ...]]:
    cells = set()
    for low, high in boxes:
        for x, y, z in np.ndindex(*np.subtract(high, low)):
            at = (x + low[0], y + low[1], z + low[2])
            cells |= {at, (-1 - at[0], at[1], at[2])}
    return cells


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
    "animal": _body(
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
    "person": _body(
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
