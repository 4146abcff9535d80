"""Closed triangle meshes of shapes with parts that recur: facades with windows, gears with teeth.
Their triangulation is irregular, so that no two instances have the same triangles."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .pieces import Mesh
from .poses import Points

Line = NDArray[np.float64]


def facade(
    rows: int,
    columns: int,
    rng: np.random.Generator,
    cells: int = 3,
    bars: bool = False,
    even: bool = False,
) -> tuple[Points, NDArray[np.int64], NDArray[np.int64]]:
    """A wall with recessed windows at uneven distances, or even ones, and a door: points, faces, and
    the window that each point is of (n,), -1 for none. ``cells``: about how often a side is divided.
    ``bars``: each window has a cross of bars in front of its pane."""
    width, height, depth = rng.uniform(0.8, 1.4), rng.uniform(1.2, 2.0), rng.uniform(0.15, 0.4)
    across, up = (
        _spread(count, size, even, rng) for count, size in ((columns, width), (rows, height))
    )
    door = (across[1], across[1] + 0.7 * width), (0.1 * height, 1.2 * height)
    up[1:] += 1.5 * height
    lines_x = _divided(np.unique(np.r_[across, door[0]]), cells, rng)
    lines_y = _divided(np.unique(np.r_[up, door[1]]), cells, rng)
    lines_z = _divided([-1.5, -depth, 0], cells, rng)
    recesses = [
        ((across[2 * i + 1], across[2 * i + 2]), (up[2 * j + 1], up[2 * j + 2]))
        for j in range(rows)
        for i in range(columns)
    ]
    surface = _Patches(rng)
    low, high = (lines_x[0], lines_y[0]), (lines_x[-1], lines_y[-1])
    for x0, x1 in pairwise(lines_x):
        for y0, y1 in pairwise(lines_y):
            if not any(
                a <= x0 and x1 <= b and c <= y0 and y1 <= d for (a, b), (c, d) in [*recesses, door]
            ):
                surface.add([x0, x1], [y0, y1], lambda u, v: (u, v, 0 * u))
    whole = lines_x, lines_y
    surface.add(*whole, lambda u, v: (u, v, 0 * u - 1.5))
    _tunnel(surface, low, high, lines_x, lines_y, lines_z)
    for recess in [*recesses, door]:
        (x0, x1), (y0, y1) = recess
        xs, ys = _between(lines_x, x0, x1), _between(lines_y, y0, y1)
        surface.add(xs, ys, lambda u, v: (u, v, 0 * u - depth))
        _tunnel(surface, (x0, y0), (x1, y1), xs, ys, _between(lines_z, -depth, 0))
    points, faces = surface.mesh()
    label = np.full(len(points), -1)
    for k, ((x0, x1), (y0, y1)) in enumerate(recesses):
        x, y, z = points.T
        label[(x >= x0) & (x <= x1) & (y >= y0) & (y <= y1) & (z >= -depth)] = k
    if bars:
        for k, ((x0, x1), (y0, y1)) in enumerate(recesses):
            for low, high in (
                ((0.45, 0.1), (0.55, 0.9)),
                ((0.1, 0.65), (0.4, 0.75)),
            ):
                box, box_faces = _bar(
                    [x0 + low[0] * (x1 - x0), y0 + low[1] * (y1 - y0), -0.8 * depth],
                    [x0 + high[0] * (x1 - x0), y0 + high[1] * (y1 - y0), -0.4 * depth],
                    rng,
                )
                faces = np.vstack([faces, box_faces + len(points)])
                points = np.vstack([points, box])
                label = np.r_[label, np.full(len(box), k)]
    return points, faces, label


def gear(
    teeth: int,
    rng: np.random.Generator,
    cells: int = 2,
    hole: bool = True,
    bulge: float = 0,
) -> tuple[Points, NDArray[np.int64], NDArray[np.int64]]:
    """A spur gear with straight flanks, or flanks that ``bulge`` by so much of their length, and a
    round hole: points, faces and the tooth that each point is of (n,), -1 where it is on none, or
    between two. The outline of straight flanks bends by more than 30 degrees at the foot of each."""
    depth, thickness = rng.uniform(0.2, 0.3), rng.uniform(0.2, 0.6)
    root, tip = rng.uniform(0.35, 0.45), rng.uniform(0.3, 0.4)
    slope = (1 - root - tip) / 2
    phases = np.array([0, slope, slope + tip, 2 * slope + tip])
    angle = 2 * np.pi * (np.arange(teeth)[:, None] + phases).ravel() / teeth
    radius = np.tile([1 - depth, 1, 1, 1 - depth], teeth)
    corners = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    heights = _divided([0, thickness], cells, rng)
    surface = _Patches(rng)
    outline, tooth = [], []
    for k, corner in enumerate(corners):
        after = corners[(k + 1) % len(corners)]
        steps = _divided([0, 1], cells, rng)
        at = corner + steps[:, None] * (after - corner)
        if bulge and k % 4 in (0, 2):
            across = np.array([after[1] - corner[1], corner[0] - after[0]])
            at += 4 * bulge * (steps * (1 - steps))[:, None] * across
        outline.append(at[:-1])
        inside = [k // 4 if k % 4 < 3 else -1] * (len(at) - 2)
        tooth += [k // 4 if k % 4 in (1, 2) else -1, *inside]
        at[-1] = after

        def wall(u: Line, v: Line, at: Line = at, steps: Line = steps) -> tuple[Line, Line, Line]:
            return np.interp(u, steps, at[:, 0]), np.interp(u, steps, at[:, 1]), v

        surface.add(steps, heights, wall)
    rim = np.vstack(outline)
    bore = 0.3 * rim / np.linalg.norm(rim, axis=1, keepdims=True)
    for height in (0.0, thickness):
        between = bore + rng.uniform(0.3, 0.6, size=(len(rim), 1)) * (rim - bore)
        surface.strip(_at(rim, height), _at(between, height))
        if hole:
            surface.strip(_at(between, height), _at(bore, height))
        else:
            surface.strip(_at(between, height), _at(np.zeros_like(bore), height))
    if hole:
        surface.strip(_at(bore, 0), _at(bore, thickness))
    points, faces = surface.mesh()
    label = np.full(len(points), -1)
    for place, number in zip(rim, tooth):
        label[np.abs(points[:, :2] - place).max(axis=1) < 1e-12] = number
    return points, faces, label


def _at(plane: Line, height: float) -> Points:
    return np.column_stack([plane, np.full(len(plane), height)])


def _spread(count: int, size: float, even: bool, rng: np.random.Generator) -> Line:
    """0, then where each of ``count`` things of a size begins and ends, then the end of all."""
    gaps = np.full(count + 1, 0.6) if even else rng.uniform(0.3, 0.9, size=count + 1)
    ends = np.cumsum(np.column_stack([gaps[:-1], np.full(count, size)]).ravel())
    return np.r_[0, ends, ends[-1] + gaps[-1]]


def _divided(lines: ArrayLike, cells: int, rng: np.random.Generator) -> Line:
    """With lines between them, at random places."""
    lines = np.asarray(lines, dtype=float)
    found = [lines[:1]]
    for a, b in pairwise(lines):
        count = rng.integers(max(1, cells - 1), cells + 2)
        shares = np.arange(1, count) + rng.uniform(-0.25, 0.25, size=count - 1)
        found += [a + (b - a) * shares / count, [b]]
    return np.concatenate(found)


def _between(lines: Line, low: float, high: float) -> Line:
    return lines[(lines >= low) & (lines <= high)]


def _tunnel(
    surface: _Patches,
    low: tuple[float, float],
    high: tuple[float, float],
    xs: Line,
    ys: Line,
    zs: Line,
) -> None:
    """The four walls from one end of ``zs`` to the other."""
    for x in (low[0], high[0]):
        surface.add(ys, zs, lambda u, v, x=x: (0 * u + x, u, v))
    for y in (low[1], high[1]):
        surface.add(xs, zs, lambda u, v, y=y: (u, 0 * u + y, v))


def _bar(low: ArrayLike, high: ArrayLike, rng: np.random.Generator) -> Mesh:
    lines = [_divided([a, b], 1, rng) for a, b in zip(np.asarray(low), np.asarray(high))]
    surface = _Patches(rng)
    _tunnel(surface, (lines[0][0], lines[1][0]), (lines[0][-1], lines[1][-1]), *lines)
    for z in (lines[2][0], lines[2][-1]):
        surface.add(lines[0], lines[1], lambda u, v, z=z: (u, v, 0 * u + z))
    return surface.mesh()


class _Patches:
    """Gridded rectangles, their inner points moved and their diagonals drawn at random."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.points: list[Points] = []
        self.faces: list[NDArray[np.int64]] = []
        self.count = 0

    def add(
        self,
        us: ArrayLike,
        vs: ArrayLike,
        place: Callable[[Line, Line], tuple[Line, Line, Line]],
    ) -> None:
        us, vs = np.asarray(us, dtype=float), np.asarray(vs, dtype=float)
        u, v = (grid.copy() for grid in np.meshgrid(us, vs, indexing="ij"))
        for grid, lines, axis in ((u, us, 0), (v, vs, 1)):
            if min(grid.shape) > 2:
                room = np.minimum(np.diff(lines)[:-1], np.diff(lines)[1:])
                room = room[:, None] if axis == 0 else room
                inner = grid[1:-1, 1:-1]
                inner += 0.3 * room * self.rng.uniform(-1, 1, size=inner.shape)
        self._add(np.stack(place(u, v), axis=-1))

    def strip(self, one: Points, other: Points) -> None:
        """Between two closed polylines."""
        rings = np.stack([one, other], axis=1)
        self._add(np.concatenate([rings, rings[:1]]))

    def _add(self, grid: NDArray[np.float64]) -> None:
        corner = self.count + np.arange(grid.shape[0] * grid.shape[1]).reshape(grid.shape[:2])
        quads = np.stack(
            [corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]], axis=-1
        ).reshape(-1, 4)
        turned = self.rng.random(len(quads)) < 0.5
        quads[turned] = np.roll(quads[turned], 1, axis=1)
        self.faces += [quads[:, :3], quads[:, [0, 2, 3]]]
        self.points.append(grid.reshape(-1, 3))
        self.count += corner.size

    def mesh(self) -> Mesh:
        """Points at the same place are one."""
        points, number = np.unique(np.vstack(self.points), axis=0, return_inverse=True)
        faces = number.reshape(-1)[np.vstack(self.faces)]
        proper = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        return points, faces[proper]
