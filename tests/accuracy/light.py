"""Light on mirrors: the points that reflect it, and how bright it is where it ends."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import symsurf

from .case import Case, Figures, at_least, at_most
from .poses import Points
from .quadric_paths import (
    KINDS,
    ParametricQuadric,
    is_reflected,
    length,
    paths,
    random_quadric,
)
from .ray_casting import CELLS, LitMirror, Screen, cast, thrown

SAME = 1e-6
"""Of the path: two points nearer to each other are one."""


def _points(subject: str, rng: np.random.Generator) -> Figures:
    """Of a random quadric, source and eye within 2 of the origin: all that brute force finds, none
    else."""
    quadric = random_quadric(subject, rng)
    source, eye = rng.uniform(-2, 2, size=(2, 3))
    return _against_brute_force(quadric, source, eye)


def _in_a_room(subject: str, rng: np.random.Generator) -> Figures:
    """A mirror of revolution, a camera on its axis in half of the trials, and a vertex of a room."""
    quadric = random_quadric(subject, rng, of_revolution=True)
    eye = quadric.centre + rng.uniform(-2, 2) * quadric.axis
    if rng.uniform() < 0.5:
        eye = rng.uniform(-2, 2, size=3)
    return _against_brute_force(quadric, rng.uniform(-4, 4, size=3), eye)


def _against_brute_force(
    quadric: ParametricQuadric, source: np.ndarray, eye: np.ndarray
) -> Figures:
    known = paths(quadric, source, eye)
    found = quadric.mirror.reflection_points(source, eye).positions
    apart = np.linalg.norm(known[:, None] - found[None], axis=2)
    lacking = apart.min(axis=1, initial=np.inf) > SAME * length(known, source, eye)
    return {"all found": float(not lacking.any()),
            "none false": float(is_reflected(quadric, found, source, eye).all()),
            "points": len(found)}  # fmt: skip


def _sphere(light: np.ndarray, rng: np.random.Generator) -> LitMirror:
    """Concave or convex."""
    radius, side = rng.uniform(2, 4), rng.choice([-1, 1])
    x0, y0 = rng.uniform(-0.3, 0.3, size=2)

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return side * (radius - np.sqrt(radius**2 - (x - x0) ** 2 - (y - y0) ** 2))

    return LitMirror(symsurf.Sphere((x0, y0, side * radius), radius), height, light)


def _cylinder(light: np.ndarray, rng: np.random.Generator) -> LitMirror:
    radius, side, turn = rng.uniform(2, 4), rng.choice([-1, 1]), rng.uniform(0, np.pi)

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return side * (radius - np.sqrt(radius**2 - (y * np.cos(turn) - x * np.sin(turn)) ** 2))

    axis = (np.cos(turn), np.sin(turn), 0)
    return LitMirror(symsurf.Cylinder((0, 0, side * radius), axis, radius), height, light)


def _quadric(light: np.ndarray, rng: np.random.Generator) -> LitMirror:
    """z = a x^2 + 2 b x y + c y^2 + d z^2 about the origin: of every kind."""
    a, b, c, d = rng.uniform(-0.25, 0.25, size=4)

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        e = a * x * x + 2 * b * x * y + c * y * y
        return 2 * e / (1 + np.sqrt(1 - 4 * d * e))

    matrix = np.array([[a, b, 0], [b, c, 0], [0, 0, d]])
    return LitMirror(symsurf.Quadric(matrix, (0, 0, -1), 0), height, light)


class _Waves:
    """Two low waves over the square, with their derivatives."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.sizes, self.phases = rng.uniform(0.02, 0.05, size=2), rng.uniform(0, 6, size=2)
        self.ways = rng.uniform(-2.5, 2.5, size=(2, 2))

    def _angles(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return (
            np.multiply.outer(x, self.ways[:, 0])
            + np.multiply.outer(y, self.ways[:, 1])
            + self.phases
        )

    def __call__(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.sin(self._angles(x, y)) @ self.sizes

    def slopes(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return (np.cos(self._angles(x, y)) * self.sizes) @ self.ways

    def bends(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Half of xx, xy and half of yy."""
        u, v = self.ways.T
        products = np.column_stack([u * u / 2, u * v, v * v / 2])
        return -(np.sin(self._angles(x, y)) * self.sizes) @ products


def _grid(half: float, count: int) -> Points:
    x, y = np.meshgrid(*2 * [np.linspace(-half, half, count)])
    return np.column_stack([x.ravel(), y.ravel(), np.zeros(count * count)])


def height_of(mirror: symsurf.Mirror) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """The height of a mirror of low slopes, by its own feet."""

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        z = np.zeros_like(x)
        for _ in range(6):  # each leaves the square of the slope of what it is off
            z = mirror.project(np.column_stack([x, y, z]))[:, 2]
        return z

    return height


def _height_field(light: np.ndarray, rng: np.random.Generator) -> LitMirror:
    nodes = _grid(1.4, 40)
    nodes[:, 2] = _Waves(rng)(nodes[:, 0], nodes[:, 1])
    field = symsurf.make_mirror("height field", {"direction": (0, 0, 1.0), "nodes": nodes})
    return LitMirror(field, height_of(field), light)


def _free_form(light: np.ndarray, rng: np.random.Generator) -> LitMirror:
    waves, centres = _Waves(rng), _grid(1.4, 20)
    x, y = centres[:, 0], centres[:, 1]
    centres[:, 2] = waves(x, y)
    rows = np.ones((len(x), 1))
    heights = np.column_stack([0 * x, waves.slopes(x, y), waves.bends(x, y)])
    form = symsurf.make_mirror("free-form", {
        "centres": centres, "tangents": rows * (1, 0, 0), "normals": rows * (0, 0, 1),
        "radii": 0.35 * rows, "heights": heights})  # fmt: skip
    return LitMirror(form, height_of(form), light)


MIRRORS = {"sphere": _sphere, "cylinder": _cylinder, "quadric": _quadric,
           "height field": _height_field, "free form": _free_form}  # fmt: skip


def _irradiance(subject: str, rng: np.random.Generator) -> Figures:
    """What lands in the cells of a screen where the mirror throws most of the light."""
    light = np.array([*rng.uniform(-1, 1, size=2), rng.uniform(1.5, 3)])
    lit = MIRRORS[subject](light, rng)
    height = rng.uniform(1, 3)
    ends, solid = cast(lit, height, rng)
    low, high = np.quantile(ends, (0.1, 0.9), axis=0)
    screen = Screen((low + high) / 2, float((high - low)[:2].max()) / 2)
    counted, ours = screen.summed(ends, solid), thrown(lit, screen, ends, solid, rng)
    off = np.abs(ours - counted)
    return {"off": off.sum() / counted.sum(), "worst cell": off.max() * CELLS**2 / counted.sum()}


def _virtual_lights(subject: str, rng: np.random.Generator) -> Figures:
    """How many virtual lights a quadric shows to each of some random points."""
    quadric = random_quadric(subject, rng)
    light = rng.uniform(-2, 2, size=3)
    screen = rng.uniform(-2, 2, size=(8, 3))
    sources = quadric.mirror.reflection_points(screen, light).sources
    counts = np.bincount(sources, minlength=len(screen))
    known = [len(paths(quadric, point, light)) for point in screen]
    return {"same number": float((counts == known).all()), "most": float(counts.max())}


_COMPLETE = {"all found": at_least(1), "none false": at_least(1)}
_OF_REVOLUTION = (
    "sphere",
    "spheroid",
    "paraboloid of revolution",
    "hyperboloid of one sheet",
    "hyperboloid of two sheets",
)

CASES = (
    Case("light, points of quadrics against brute force", KINDS, _points, _COMPLETE),
    Case("light, irradiance against ray casting", tuple(MIRRORS), _irradiance,
         {"off": at_most(0.02)}),
    Case("neighbours, light: Mitchell and Hanrahan, virtual lights",
         ("ellipsoid", "saddle", "elliptic cylinder"), _virtual_lights,
         {"same number": at_least(1)}, trials=10),
    Case("neighbours, light: Mitchell and Hanrahan, irradiance", ("quadric", "free form"), _irradiance,
         {"off": at_most(0.02)}, trials=10),
    Case("neighbours, light: Miguel, room in a mirror of revolution", _OF_REVOLUTION, _in_a_room,
         _COMPLETE, trials=10),
)  # fmt: skip
