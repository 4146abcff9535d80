"""Coloured objects: what is painted on them breaks the symmetry of their shape, or does not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .symmetric_parts import box, gear, sphere, turned

Array = NDArray[np.float64]

PAPER, INK, THIRD = np.array([(0.85, 0.8, 0.7), (0.1, 0.2, 0.6), (0.7, 0.1, 0.1)])


@dataclass(frozen=True)
class ColouredPart:
    group: str
    """Of shape and colours."""
    triangles: Array
    """(m, 3, 3) corners."""
    painted: Callable[[Array], Array]
    """(n, 3) colours of (n, 3) points."""

    def mesh(self, edge: float) -> tuple[Array, Array, Array]:
        """Vertices, faces and the vertices' colours, with edges no longer than that. Corners that two
        faces share are two vertices, so that each can have a colour of its own."""
        triangles = self.triangles
        sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
        triangles = triangles[sides.min(axis=1) > 1e-9]
        while np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max() > edge:
            triangles = _halved(triangles, edge)
        # The colour of a face is asked for just inside it.
        middles = triangles.mean(axis=1, keepdims=True)
        colours = self.painted((triangles + 1e-4 * (middles - triangles)).reshape(-1, 3))
        return triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), colours


def _halved(triangles: Array, edge: float) -> Array:
    """Those with a longer side divided at the middle of the longest."""
    lengths = np.linalg.norm(np.roll(triangles, -1, axis=1) - triangles, axis=2)
    long = lengths.max(axis=1) > edge
    divided, longest = triangles[long], lengths[long].argmax(axis=1)
    rows = np.arange(len(divided))
    a, b, c = (divided[rows, (longest + k) % 3] for k in range(3))
    middle = (a + b) / 2
    return np.concatenate(
        [triangles[~long], np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
    )


def _where(chosen: Array, colour: Array = INK, other: Array = PAPER) -> Array:
    return np.where(chosen[:, None], colour, other)


def _angle(points: Array) -> Array:
    return np.arctan2(points[:, 1], points[:, 0])


def _side_label(points: Array, width: float, low: float, high: float, at: float = 0.0) -> Array:
    """Within an angle about z to both sides of a direction, and between two heights."""
    off = np.abs((_angle(points) - at + np.pi) % (2 * np.pi) - np.pi)
    return (off < width) & (points[:, 2] > low) & (points[:, 2] < high)


def _sectors(points: Array, count: int, twist: float = 0.0, start: float = 0.0) -> Array:
    """Which of so many sectors about z, turned by so much a unit of height."""
    turn = (_angle(points) - start + twist * points[:, 2]) / (2 * np.pi)
    return np.floor(count * (turn % 1)).astype(int)


def _near(points: Array, direction: tuple[float, float, float], angle: float) -> Array:
    unit = np.asarray(direction) / np.linalg.norm(direction)
    return points @ unit > np.cos(angle) * np.linalg.norm(points, axis=1)


BOX, CUBE, BALL, GEAR = box(2, 1.4, 0.9), box(1.4, 1.4, 1.4), sphere(), gear(12)
BOTTLE = turned([0, 0.5, 0.5, 0.2, 0.2, 0], [-1, -1, 0.3, 0.7, 1, 1])
CAN = turned([0, 0.5, 0.5, 0], [-0.8, -0.8, 0.8, 0.8])
PITCH = 2 * np.pi / 12
TOOTH = 0.65 * PITCH  # where the middle of the first one stands
CUP = turned([0, 0.5, 0.7, 0.6, 0.4, 0], [-0.6, -0.6, 0.6, 0.6, -0.5, -0.5])

COLOURED_PARTS = {
    "plain box": ColouredPart("D2h", BOX, lambda x: _where(x[:, 0] > 9)),
    "box with a label": ColouredPart(
        "C2v", BOX, lambda x: _where((x[:, 2] > 0.44) & (abs(x[:, 0]) < 0.6) & (abs(x[:, 1]) < 0.3))
    ),
    "box with a stamp in a corner": ColouredPart(
        "C1",
        BOX,
        lambda x: _where((x[:, 2] > 0.44) & (abs(x[:, 0] - 0.7) < 0.15) & (x[:, 1] > 0.4)),
    ),
    "box of two halves": ColouredPart("C2v", BOX, lambda x: _where(x[:, 2] > 0)),
    "cube of three pairs of sides": ColouredPart(
        "D2h", CUBE, lambda x: np.array([PAPER, INK, THIRD])[abs(x).argmax(axis=1)]
    ),
    "cube with a painted side": ColouredPart("C4v", CUBE, lambda x: _where(x[:, 0] > 0.69)),
    "cube of eight checkers": ColouredPart("Td", CUBE, lambda x: _where(x.prod(axis=1) > 0)),
    "bottle with a label": ColouredPart(
        "Cs", BOTTLE, lambda x: _where(_side_label(x, 0.8, -0.7, 0.1))
    ),
    "bottle with two labels": ColouredPart(
        "C2v",
        BOTTLE,
        lambda x: _where(_side_label(x, 0.6, -0.7, 0.1) | _side_label(x, 0.6, -0.7, 0.1, np.pi)),
    ),
    "bottle with a small sticker": ColouredPart(
        "Cs", BOTTLE, lambda x: _where(_side_label(x, 0.2, -0.3, -0.1), THIRD)
    ),
    "bottle with an unlike pair of labels": ColouredPart(
        "C1",
        BOTTLE,
        lambda x: np.where(
            _side_label(x, 0.4, -0.7, -0.2)[:, None],
            INK,
            _where(_side_label(x, 0.4, -0.3, 0.2, 2.0), THIRD),
        ),
    ),
    "bottle with rings": ColouredPart(
        "C∞v", BOTTLE, lambda x: _where(np.floor(5 * x[:, 2]) % 2 == 0)
    ),
    "cup with three dots": ColouredPart(
        "C3v",
        CUP,
        lambda x: _where(
            _side_label(x, 0.25, -0.1, 0.2)
            | _side_label(x, 0.25, -0.1, 0.2, 2 * np.pi / 3)
            | _side_label(x, 0.25, -0.1, 0.2, -2 * np.pi / 3)
        ),
    ),
    "cup with twisted stripes": ColouredPart(
        "C4", CUP, lambda x: _where(_sectors(x, 8, twist=2.0) % 2 == 0)
    ),
    "cup with twelve stripes": ColouredPart(
        "C12v", CUP, lambda x: _where(_sectors(x, 24) % 2 == 0)
    ),
    "can with a label": ColouredPart("C2v", CAN, lambda x: _where(_side_label(x, 0.9, -0.4, 0.4))),
    "can of checkers": ColouredPart(
        "D4d", CAN, lambda x: _where((_sectors(x, 8) + (x[:, 2] > 0)) % 2 == 0)
    ),
    "can with a painted end": ColouredPart("C∞v", CAN, lambda x: _where(x[:, 2] > 0.3)),
    "ball with a dot": ColouredPart("C∞v", BALL, lambda x: _where(_near(x, (1, 2, -1), 0.3))),
    "ball with a ring": ColouredPart("D∞h", BALL, lambda x: _where(abs(x[:, 2]) < 0.2)),
    "beach ball": ColouredPart("D3h", BALL, lambda x: _where(_sectors(x, 6) % 2 == 0)),
    "ball of eight checkers": ColouredPart("Td", BALL, lambda x: _where(x.prod(axis=1) > 0)),
    "ball with a long label": ColouredPart(
        "C2v", BALL, lambda x: _where(_side_label(x, 0.7, -0.25, 0.25))
    ),
    "plain gear": ColouredPart("D12h", GEAR, lambda x: _where(x[:, 0] > 9)),
    "gear with a painted tooth": ColouredPart(
        "C2v",
        GEAR,
        lambda x: _where(_side_label(x, PITCH / 2, -1, 1, TOOTH) & (np.hypot(*x.T[:2]) > 0.85)),
    ),
    "gear with three painted sectors": ColouredPart(
        "D3h", GEAR, lambda x: _where(_sectors(x, 12, start=TOOTH - PITCH / 2) % 4 == 0)
    ),
    "gear with a painted face": ColouredPart("C12v", GEAR, lambda x: _where(x[:, 2] > 0.14)),
}
