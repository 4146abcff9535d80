"""``auto``, and ``perpendicular``, where every point has an exact partner: it says so, and scores
it 1."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial import KDTree

import symsurf
from symsurf import Cylinder, Mirror, Plane, Sphere

from .case import Case, Figures, at_least, timed_detect
from .poses import Points, diagonal, random_rotation
from .solids import ASYMMETRIC, asymmetric, bent, mirrored_mesh

EXACT = 1e-9
"""Of the diagonal, and of the score."""
LEAST, MOST = 20, 20_000


def exact_share(mirror: Mirror | None, points: Points) -> float:
    """The share of the points whose image is one of them."""
    if mirror is None:
        return 0.0
    images = mirror.reflect(points)
    images = images[np.isfinite(images).all(axis=1)]
    distances = KDTree(points).query(images)[0] if len(images) else np.empty(0)
    return float((distances <= EXACT * diagonal(points)).sum() / len(points))


def _judged(points: Points, kind: str, rng: np.random.Generator, method: str = "auto") -> Figures:
    points = rng.permutation(points) @ random_rotation(rng).T
    result, seconds = timed_detect(points, method)
    partners = exact_share(result.mirror, points)
    found = result.statistics["verdict"] == "found"
    right = found and partners == 1 and result.score >= 1 - EXACT
    named = result.mirror is not None and result.mirror.kind == kind
    return {"right": float(right), "exact partners": float(partners == 1), "named": float(named),
            "score": result.score, "seconds": seconds}  # fmt: skip


def _gaussian(count: int, rng: np.random.Generator) -> Points:
    return rng.normal(size=(count, 3)) * rng.uniform(0.3, 1, size=3) @ random_rotation(rng).T


def _uniform(count: int, rng: np.random.Generator) -> Points:
    return rng.uniform(-1, 1, (count, 3)) * rng.uniform(0.3, 1, size=3) @ random_rotation(rng).T


def _lattice(count: int, rng: np.random.Generator) -> Points:
    """All points of a grid in a box, or some of them in a larger one."""
    filled = rng.choice([1.0, rng.uniform(0.2, 0.8)])
    sides = rng.uniform(0.4, 1, size=3)
    sides = np.ceil(sides * (count / filled / sides.prod()) ** (1 / 3)).astype(int)
    points = np.indices(sides).reshape(3, -1).T - sides // 2
    return points[rng.permutation(len(points))[: round(filled * len(points))]].astype(float)


def _integer(count: int, rng: np.random.Generator) -> Points:
    """Coordinates from a small or large range; a small one repeats points."""
    reach = int(rng.choice([3, 10, 100, 1000]))
    return rng.integers(-reach, reach + 1, size=(count, 3)).astype(float)


def _surface(count: int, rng: np.random.Generator) -> Points:
    return asymmetric(str(rng.choice(ASYMMETRIC)), count, rng) @ random_rotation(rng).T


CLOUDS: dict[str, Callable[[int, np.random.Generator], Points]] = {
    "Gaussian": _gaussian, "uniform": _uniform, "lattice": _lattice, "integer": _integer,
    "surface": _surface,
}  # fmt: skip


def _mirror(kind: str, points: Points, on_grid: bool, rng: np.random.Generator) -> Mirror:
    """A random one through the inner half of the points' box; a plane across x, so that grids
    are mirrored onto themselves."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    foot = middle + rng.uniform(-0.25, 0.25, size=3) * np.ptp(points, axis=0)
    if kind == "plane":
        return Plane((1, 0, 0), -np.round(2 * foot[0]) / 2 if on_grid else -foot[0])
    radius = rng.uniform(0.3, 1.5) * diagonal(points)
    outward, axis = random_rotation(rng)[:2]
    centre = foot - radius * outward
    return Sphere(centre, radius) if kind == "sphere" else Cylinder(centre, axis, radius)


def _mirrored(kind: str, method: str = "auto") -> Callable[[str, np.random.Generator], Figures]:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        half = round(np.exp(rng.uniform(np.log(LEAST), np.log(MOST))) / 2)
        # More than asked for: some lie where the mirror sends nothing.
        points = CLOUDS[subject](half if subject == "lattice" else 3 * half, rng)
        mirror = _mirror(kind, points, subject in ("lattice", "integer"), rng)
        if kind != "plane":
            near = np.abs(mirror.signed_distance(points)) < 0.95 * mirror.radius
            points = points[near]
        points = points[:half]
        points = np.vstack([points, mirror.reflect(points)])
        if subject == "lattice":
            points = np.unique(points, axis=0)
        return _judged(points, kind, rng, method)

    return run


def _random_half(subject: str, rng: np.random.Generator) -> Figures:
    cloud, count = subject.split()
    half = rng.normal(size=(int(count), 3)) * [1, 2, 3]
    if cloud == "uniform":
        half = rng.uniform((0, -2, -3), (1, 2, 3), size=(int(count), 3))
    return _judged(np.vstack([half, half * [-1, 1, 1]]), "plane", rng)


def _bent_airplane(subject: str, rng: np.random.Generator) -> Figures:
    """Its vertices, whose plane is exact to single precision, with a cylinder of that radius."""
    points, _, plane = mirrored_mesh("airplane")
    along = max(np.ptp(points, axis=0)[1:])
    points, cylinder = bent(points, plane, float(subject.split()[-1]) / along)
    result, seconds = timed_detect(points @ random_rotation(rng).T, "auto")
    named = isinstance(result.mirror, symsurf.Cylinder)
    miss = abs(result.mirror.radius / cylinder.radius - 1) if named else np.inf
    return {"named": float(named), "radius off": miss, "score": result.score, "seconds": seconds}


_RIGHT = {"right": at_least(1)}

CASES = (
    *(Case(f"auto, exact {kind}", tuple(CLOUDS), _mirrored(kind), _RIGHT, trials=35)
      for kind in ("plane", "sphere", "cylinder")),
    Case("perpendicular, exact plane", tuple(CLOUDS), _mirrored("plane", "perpendicular"), _RIGHT,
         trials=35),
    Case("auto, a random half and its image",
         tuple(f"{cloud} {n}" for cloud in ("Gaussian", "uniform") for n in (100, 300, 1000)),
         _random_half, {**_RIGHT, "named": at_least(1)}),
    Case("auto, bent airplane, exact partners", ("radius 1500", "radius 3000"), _bent_airplane,
         {"named": at_least(1)}, trials=5),
)  # fmt: skip
