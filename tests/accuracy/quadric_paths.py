"""All ways of light over a quadric, by brute force: what ``reflection_points`` is held against.

Nothing here is the core's: a dense grid of the surface's own parameters sees where the length of the
path is nearly stationary, and Newton's steps on Mitchell and Hanrahan's system, grad d + l grad g = 0
and g = 0, go from there to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import symsurf

from .poses import Points, random_rotation

GRID = 400  # of each of the two parameters; far parts lie in steps of equal ratios
REACH = np.arcsinh(3e3)  # how far an unbounded quadric is looked at, about a thousand sizes
STEPS = 60  # of Newton's
STATIONARY = 1e-10  # of the path, for one way along the mirror
KINDS = ("ellipsoid", "sphere", "spheroid", "hyperboloid of one sheet", "hyperboloid of two sheets",
         "cone", "paraboloid", "paraboloid of revolution", "saddle", "elliptic cylinder",
         "hyperbolic cylinder", "parabolic cylinder")  # fmt: skip


@dataclass(frozen=True)
class ParametricQuadric:
    """x . A x + b . x + c = 0, and points of it in grids (sheets, GRID, GRID, 3) of two
    parameters."""

    matrix: np.ndarray
    linear: np.ndarray
    constant: float
    grids: np.ndarray
    centre: np.ndarray
    axis: np.ndarray

    @property
    def mirror(self) -> symsurf.Quadric:
        return symsurf.Quadric(self.matrix, self.linear, self.constant)

    def value(self, x: Points) -> np.ndarray:
        return ((x @ self.matrix + self.linear) * x).sum(axis=-1) + self.constant

    def gradient(self, x: Points) -> Points:
        return 2 * x @ self.matrix + self.linear


def random_quadric(
    kind: str, rng: np.random.Generator, of_revolution: bool = False
) -> ParametricQuadric:
    """Of random axes of 0.5 to 2, turned and moved at random by less than 0.3."""
    a, b, c = np.exp(rng.uniform(np.log(0.5), np.log(2), size=3))
    if kind == "sphere":
        b = c = a
    elif of_revolution or kind in ("spheroid", "paraboloid of revolution"):
        b = a
    signs, linear, constant, points = _canonical(kind)
    scale = np.array([a, b, c])
    rotation, shift = random_rotation(rng), rng.uniform(-0.3, 0.3, size=3)
    # y = R^T (x - t) / scale is a canonical point.
    to = (rotation / scale).T
    matrix = to.T @ np.diag(signs) @ to
    slope = to.T @ linear
    return ParametricQuadric(
        matrix,
        slope - 2 * matrix @ shift,
        constant - slope @ shift + shift @ matrix @ shift,
        np.stack([p * scale @ rotation.T + shift for p in points]),
        shift,
        rotation[:, 2],
    )


def _canonical(kind: str) -> tuple[Points, Points, float, list[Points]]:
    """Signs of the squares, linear part, constant and sheets."""
    turn = np.linspace(0, 2 * np.pi, GRID)
    far = np.linspace(-REACH, REACH, GRID)
    zero, up = np.zeros(3), np.array([0, 0, -1.0])

    def sheet(x, y, z, u, v):
        u, v = np.meshgrid(u, v, indexing="ij")
        return np.stack(np.broadcast_arrays(x(u, v), y(u, v), z(u, v)), axis=-1)

    def around(radius, height, u):
        return sheet(lambda u, v: radius(u) * np.cos(v), lambda u, v: radius(u) * np.sin(v),
                     lambda u, v: height(u), u, turn)  # fmt: skip

    if kind in ("ellipsoid", "sphere", "spheroid"):
        return (np.ones(3), zero, -1, [around(np.sin, np.cos, np.linspace(0, np.pi, GRID))])
    if kind == "hyperboloid of one sheet":
        return np.array([1.0, 1, -1]), zero, -1, [around(np.cosh, np.sinh, far)]
    if kind == "hyperboloid of two sheets":
        half = np.linspace(0, REACH, GRID)
        sheets = [around(np.sinh, lambda u, s=s: s * np.cosh(u), half) for s in (-1, 1)]
        return np.array([1.0, 1, -1]), zero, 1, sheets
    if kind == "cone":
        return np.array([1.0, 1, -1]), zero, 0, [around(np.sinh, np.sinh, far)]
    if kind.startswith("paraboloid"):
        half = np.linspace(0, REACH, GRID)
        return (np.array([1.0, 1, 0]), up, 0, [around(np.sinh, lambda u: np.sinh(u) ** 2, half)])
    if kind == "saddle":
        return np.array([1.0, -1, 0]), up, 0, [sheet(
            lambda u, v: np.sinh(u), lambda u, v: np.sinh(v),
            lambda u, v: np.sinh(u) ** 2 - np.sinh(v) ** 2, far, far)]  # fmt: skip
    if kind == "elliptic cylinder":
        return (np.array([1.0, 1, 0]), zero, -1, [around(np.ones_like, np.sinh, far)])
    if kind == "hyperbolic cylinder":
        sheets = [sheet(lambda u, v, s=s: s * np.cosh(u), lambda u, v: np.sinh(u),
                        lambda u, v: np.sinh(v), far, far) for s in (-1, 1)]  # fmt: skip
        return np.array([1.0, -1, 0]), zero, -1, sheets
    if kind == "parabolic cylinder":
        return np.array([1.0, 0, 0]), up, 0, [sheet(
            lambda u, v: np.sinh(u), lambda u, v: np.sinh(v), lambda u, v: np.sinh(u) ** 2,
            far, far)]  # fmt: skip
    raise ValueError(kind)


def paths(quadric: ParametricQuadric, source: np.ndarray, eye: np.ndarray) -> Points:
    """(m, 3) all points at which the quadric reflects the source to the eye, each once."""
    starts = [_starts(quadric, grid, source, eye) for grid in quadric.grids]
    starts += [_beside(quadric, end) for end in (source, eye)]
    x = _newton(quadric, np.concatenate(starts), source, eye)
    x = x[is_reflected(quadric, x, source, eye)]
    distinct: list[np.ndarray] = []
    for point in x:
        if all(np.linalg.norm(point - other) > 1e-6 * length(point, source, eye)
               for other in distinct):  # fmt: skip
            distinct.append(point)
    return np.array(distinct).reshape(-1, 3)


def length(x: Points, source: np.ndarray, eye: np.ndarray) -> np.ndarray:
    return np.linalg.norm(source - x, axis=-1) + np.linalg.norm(eye - x, axis=-1)


def is_reflected(
    quadric: ParametricQuadric, x: Points, source: np.ndarray, eye: np.ndarray
) -> np.ndarray:
    """On the mirror, the path stationary, both ends on one side of the tangent plane."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        gradient = quadric.gradient(x)
        steepness = np.linalg.norm(gradient, axis=-1)
        normal = gradient / steepness[:, None]
        u, v = _unit(source - x), _unit(eye - x)
        off = np.abs(quadric.value(x)) / steepness
        along = np.linalg.norm(np.cross(u + v, normal), axis=-1)
        sides = (u * normal).sum(axis=-1) * (v * normal).sum(axis=-1)
        near = STATIONARY * (1 + np.linalg.norm(x, axis=-1))
        is_apex = steepness < 1e-6  # of a cone, where no normal is
        return ~is_apex & (off <= near) & (along <= STATIONARY) & (sides > 1e-12)


def _starts(
    quadric: ParametricQuadric, grid: np.ndarray, source: np.ndarray, eye: np.ndarray
) -> Points:
    """Corners of the cells in which both slopes of the path's length along the grid change sign, or
    nearly so, and where the length along the mirror changes least."""
    pull = _unit(source - grid) + _unit(eye - grid)
    normal = _unit(quadric.gradient(grid))
    slopes = [(pull * np.gradient(grid, axis=k)).sum(axis=-1) for k in (0, 1)]
    changing = [_any_nearby(s > 0) & _any_nearby(s < 0) for s in slopes]
    descent = np.linalg.norm(np.cross(pull, normal), axis=-1)
    lowest = descent <= _least_nearby(descent)
    return grid[(changing[0] & changing[1]) | lowest]


def _beside(quadric: ParametricQuadric, end: np.ndarray) -> Points:
    """Where an end that is near the mirror may be reflected between two points of the grid: points
    about its foot, in steps of its distance."""
    foot = end
    for _ in range(20):
        gradient = quadric.gradient(foot)
        foot = foot - quadric.value(foot) / (gradient @ gradient) * gradient
    across = np.linalg.svd(quadric.gradient(foot)[None])[2][1:]
    steps = np.stack(np.meshgrid(*2 * [np.linspace(-3, 3, 13)])).reshape(2, -1).T
    return foot + np.linalg.norm(end - foot) * steps @ across


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / (np.linalg.norm(vectors, axis=-1, keepdims=True) + 1e-300)


def _nearby(grid: np.ndarray) -> list[np.ndarray]:
    padded = np.pad(grid, 1, mode="edge")
    rows, columns = grid.shape
    return [padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]


def _any_nearby(grid: np.ndarray) -> np.ndarray:
    return np.any(_nearby(grid), axis=0)


def _least_nearby(grid: np.ndarray) -> np.ndarray:
    return np.min(_nearby(grid), axis=0)


def _newton(quadric: ParametricQuadric, x: Points, source: np.ndarray, eye: np.ndarray) -> Points:
    """Of the system of four equations, each step no longer than a fifth of the path."""
    gradient = quadric.gradient(x)
    weight = ((_unit(source - x) + _unit(eye - x)) * gradient).sum(axis=-1)
    weight /= (gradient**2).sum(axis=-1) + 1e-300
    left = np.zeros((len(x), 4, 4))
    for _ in range(STEPS):
        gradient = quadric.gradient(x)
        pull, bend = 0, 2 * weight[:, None, None] * quadric.matrix
        for end in (source, eye):
            u, far = _unit(end - x), np.linalg.norm(end - x, axis=-1)[:, None, None]
            pull = pull + u
            bend = bend + (np.eye(3) - u[:, :, None] * u[:, None, :]) / far
        left[:, :3, :3], left[:, :3, 3], left[:, 3, :3] = bend, gradient, gradient
        right = np.column_stack([pull - weight[:, None] * gradient, -quadric.value(x)])
        step = _solved(left, right)
        size = np.linalg.norm(step[:, :3], axis=1)
        step *= np.minimum(1, 0.2 * length(x, source, eye) / (size + 1e-300))[:, None]
        x, weight = x + step[:, :3], weight + step[:, 3]
    return x


def _solved(left: np.ndarray, right: np.ndarray) -> np.ndarray:
    regular = np.isfinite(left).all(axis=(1, 2)) & np.isfinite(right).all(axis=1)
    regular[regular] = np.abs(np.linalg.det(left[regular])) > 0
    step = np.full_like(right, np.nan)
    step[regular] = np.linalg.solve(left[regular], right[regular][:, :, None])[:, :, 0]
    return step
