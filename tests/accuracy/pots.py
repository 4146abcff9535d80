"""Pots and gears of which part of the turn is missing, and the axis that they are turned about."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import symsurf
from symsurf import Axis, Shape

from .case import Case, Figures, at_most
from .damage import noise
from .poses import Points, diagonal, random_rotation
from .solids import sampled

Faces = NDArray[np.int64]
KINDS = ("sheet", "walls", "sheet cloud", "walls cloud")
STEPS = 180  # of the turn
CLOUD = 12_000  # points of a whole pot
NOISE = 0.003  # of the diagonal


def profile(walls: bool, rng: np.random.Generator) -> NDArray[np.float64]:
    """(k, 2) radii and heights of a belly or a neck: of a sheet, or out along the outer wall and back
    along the inner one."""
    along = np.linspace(0, 1, 80)
    waves = np.sin(2 * np.pi * (along * rng.uniform(0.6, 1.2) + rng.random()))
    radius = 0.35 + rng.uniform(0.05, 0.12) * waves + rng.uniform(-0.12, 0.12) * along
    outer = np.column_stack([rng.uniform(0.8, 1.3) * radius, rng.uniform(0.7, 1.3) * along])
    if not walls:
        return outer
    across = np.gradient(outer, axis=0)[:, ::-1] * (-1, 1)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    return np.vstack([outer, (outer + rng.uniform(0.02, 0.05) * across)[::-1]])


def grid_faces(rows: int, columns: int) -> Faces:
    """Triangles of closed rings of points, ring after ring."""
    index = np.arange(rows * columns).reshape(rows, columns)
    a, c = index[:-1], index[1:]
    b, d = np.roll(a, -1, axis=1), np.roll(c, -1, axis=1)
    return np.concatenate([np.stack(f, -1).reshape(-1, 3) for f in ((a, b, d), (a, d, c))])


def turned(
    outline: NDArray[np.float64], steps: int = STEPS
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points and faces of the surface that a profile sweeps about z."""
    angle = 2 * np.pi * np.arange(steps) / steps
    radius, height = (outline[:, k, None] + 0 * angle for k in (0, 1))
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=2)
    return points.reshape(-1, 3), grid_faces(len(outline), steps)


def gear(teeth: int, rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A helical one of teeth that lean to one side: without a mirror."""
    angle = 2 * np.pi * np.arange(40 * teeth) / (40 * teeth)
    phase, lean = teeth * angle / (2 * np.pi) % 1, rng.uniform(0.55, 0.8)
    ramp = np.where(phase < lean, phase / lean, (1 - phase) / (1 - lean))
    rim = 1 + rng.uniform(0.12, 0.25) * np.clip(1.8 * ramp - 0.4, 0, 1)
    twist, height = rng.uniform(0.3, 1) * 2 * np.pi / teeth, rng.uniform(0.2, 0.5)
    hub = np.linspace(0.4, 0.97, 8)
    rings = [(0.0, r) for r in hub] + [(s, rim) for s in np.linspace(0, 1, 25)]
    rings += [(1.0, r) for r in hub[::-1]]
    points = [
        np.column_stack(
            [r * np.cos(angle + s * twist), r * np.sin(angle + s * twist), height * s + 0 * angle]
        )
        for s, r in rings
    ]
    return np.concatenate(points), grid_faces(len(rings), len(angle))


def posed(points: Points, faces: Faces, order: int, rng: np.random.Generator) -> tuple[Shape, Axis]:
    """The shape somewhere, of some size, and its axis, which was z."""
    rotation, shift = random_rotation(rng), rng.normal(size=3)
    scale = np.exp(rng.normal())
    return Shape(scale * points @ rotation.T + shift, faces), Axis(shift, rotation[:, 2], order)


def left(whole: Shape, axis: Axis, missing: float, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Of each point whether it is left when that share of the turn is missing, broken along waves."""
    x = whole.points - axis.point
    height = x @ axis.direction
    u = np.linalg.qr(np.column_stack([axis.direction, np.eye(3)]))[0][:, 1:]
    angle = np.arctan2(x @ u[:, 0], x @ u[:, 1]) / (2 * np.pi) + rng.random()
    waves = 0.02 * np.sin(rng.uniform(5, 15) * height / np.ptp(height) + rng.uniform(0, 6))
    return (angle + waves) % 1 >= missing


def cut(whole: Shape, kept: NDArray[np.bool_], share: float, rng: np.random.Generator) -> Shape:
    """The faces whose corners are kept, with so much noise."""
    assert whole.faces is not None
    points = noise(whole.points, share, rng)
    used, corners = np.unique(whole.faces[kept[whole.faces].all(axis=1)], return_inverse=True)
    return Shape(points[used], corners.reshape(-1, 3))


def broken_pot(kind: str, missing: float, rng: np.random.Generator) -> tuple[Shape, Shape, Axis]:
    """What is left, the whole pot and its axis."""
    whole, axis = posed(*turned(profile("walls" in kind, rng)), 0, rng)
    if "cloud" not in kind:
        return cut(whole, left(whole, axis, missing, rng), NOISE, rng), whole, axis
    assert whole.faces is not None
    cloud = Shape(sampled(whole.points, whole.faces, CLOUD, rng))
    kept = left(cloud, axis, missing, rng)
    return Shape(noise(cloud.points, NOISE, rng)[kept]), whole, axis


def degrees_between(found: Axis, truth: Axis) -> float:
    cross = np.linalg.norm(np.cross(found.direction, truth.direction))
    return float(np.degrees(np.arcsin(min(cross, 1.0))))


def added_error(made: symsurf.Completed, whole: Shape) -> float:
    """The distance from the whole surface that 95 % of what was added is within, in diagonals;
    infinite where nothing was added."""
    import pyvista

    shape, given = made.shape, made.given
    added = shape.points[len(given.points) :]
    if shape.faces is not None and given.faces is not None:
        added = shape.points[shape.faces[len(given.faces) :]].mean(axis=1)
    if not len(added):
        return float("inf")
    target = pyvista.PolyData.from_regular_faces(whole.points, whole.faces)
    _, closest = target.find_closest_cell(added, return_closest_point=True)
    distances = np.linalg.norm(added - closest, axis=1)
    return float(np.quantile(distances, 0.95)) / diagonal(whole.points)


def left_open(made: symsurf.Completed, whole: Shape) -> float:
    """The share of the whole surface that lies farther than 2 % of the diagonal from all points."""
    import pyvista

    cloud = pyvista.PolyData(made.shape.points)
    some = whole.points[:: max(1, len(whole.points) // 1000)]
    nearest = np.array([cloud.find_closest_point(x) for x in some])
    distances = np.linalg.norm(made.shape.points[nearest] - some, axis=1)
    return float(np.mean(distances > 0.02 * diagonal(whole.points)))


def _completed(kind: str, rng: np.random.Generator) -> Figures:
    given, whole, axis = broken_pot(kind, rng.uniform(0.1, 0.65), rng)
    made = symsurf.complete(given, symmetry="axis", threads=1)
    assert made.axis is not None
    return {
        "degrees": degrees_between(made.axis, axis),
        "added": added_error(made, whole),
        "left open": left_open(made, whole),
    }


def _sherd(kind: str, rng: np.random.Generator) -> Figures:
    given, whole, axis = broken_pot(kind, 0.8, rng)
    found = symsurf.symmetries(given, threads=1).axes
    made = symsurf.complete(given, symmetry=axis, threads=1)
    return {
        "degrees": degrees_between(found[0], axis) if found else float("inf"),
        "added, axis given": added_error(made, whole),
    }


def _gear(teeth: str, rng: np.random.Generator) -> Figures:
    whole, axis = posed(*gear(int(teeth), rng), int(teeth), rng)
    given = cut(whole, left(whole, axis, 1 / 3, rng), 0, rng)
    made = symsurf.complete(given, symmetry=axis, threads=1)
    return {"added, axis given": added_error(made, whole), "left open": left_open(made, whole)}


CASES = (
    Case("complete, pots with 10 to 65 % of the turn missing, noise 0.3 %", KINDS, _completed,
         {"degrees": at_most(0.5), "added": at_most(0.005), "left open": at_most(0.01)}, trials=5),
    Case("complete, a fifth of the turn of a pot, noise 0.3 %", KINDS, _sherd,
         {"degrees": at_most(0.5), "added, axis given": at_most(0.005)}, trials=5),
    Case("complete, helical gears with a third missing", ("5", "7", "12", "16"), _gear,
         {"added, axis given": at_most(0.005), "left open": at_most(0.01)}, trials=5),
)  # fmt: skip
