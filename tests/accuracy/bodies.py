"""Bodies whose plane of symmetry was bent: a cylinder, a wave, a twist, a dome; and straight ones."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

import symsurf
from symsurf import Cylinder, Plane

from .case import Bar, Case, Figures, at_least, at_most, timed_detect
from .damage import noise
from .poses import Points, diagonal, random_rotation
from .solids import MESHES, bent, mirrored_mesh, sampled

COUNT = 10000
NEAR = 0.01  # of the diagonal: an image that lies as near to the true one is right
AMPLITUDES = (0.03, 0.1)  # of the diagonal, how far the mirror bends away from its plane
RADIUS = 0.8  # of the diagonal, of the cylinder
STEEPEST = 0.8  # of a mirror's radius of curvature: points further from it have other feet

Array = NDArray[np.float64]
Jet = tuple[Array, Array, Array]  # a height and its two slopes


def wave(u: Array, v: Array, amplitude: float, reach: float) -> Jet:
    """One wave along u, longer where points reach further from the mirror than it could bend."""
    number = min(2 * np.pi, np.sqrt(STEEPEST / (reach * amplitude)))
    height, slope = amplitude * np.sin(number * u), amplitude * number * np.cos(number * u)
    return height, slope, np.zeros_like(v)


def twist(u: Array, v: Array, amplitude: float, reach: float) -> Jet:
    """A hyperbolic paraboloid, as a helicoid is near its axis."""
    turn = min(amplitude / np.abs(u * v).max(), STEEPEST / reach)
    return turn * u * v, turn * v, turn * u


def dome(u: Array, v: Array, amplitude: float, reach: float) -> Jet:
    sag = min(amplitude / (u**2 + v**2).max(), STEEPEST / reach / 2)
    return sag * (u**2 + v**2), 2 * sag * u, 2 * sag * v


BENDS: dict[str, Callable[[Array, Array, float, float], Jet]] = {
    "wave": wave,
    "twist": twist,
    "dome": dome,
}


def body(
    mesh: str, bend: str, count: int, rng: np.random.Generator, amplitude: float | None = None
) -> tuple[Points, Points]:
    """Points of a mesh whose plane was bent, each side with its own, and their true images."""
    points, faces, plane = mirrored_mesh(mesh)
    return bent_body(sampled(points, faces, count, rng), plane, bend, rng, amplitude)


def bent_body(
    points: Points,
    plane: Plane,
    bend: str,
    rng: np.random.Generator,
    amplitude: float | None = None,
) -> tuple[Points, Points]:
    """Points about a plane after it was bent, and their true images, in a pose of their own."""
    rotation = random_rotation(rng)
    if amplitude is None:
        amplitude = rng.uniform(*AMPLITUDES)
    if bend == "straight":
        return points @ rotation.T, plane.reflect(points) @ rotation.T
    if bend == "cylinder":
        ways = np.linalg.svd(plane.normal[None])[2][1:]
        longest = max(np.ptp(points @ way) for way in ways)
        points, mirror = bent(points, plane, RADIUS * diagonal(points) / longest)
        assert isinstance(mirror, Cylinder)
        return points @ rotation.T, mirror.reflect(points) @ rotation.T
    size = diagonal(points)
    height = plane.signed_distance(points)[:, None] / size
    foot = plane.project(points)
    ways = np.linalg.svd(foot - foot.mean(axis=0), full_matrices=False)[2][:2]
    u, v = (foot @ way / size for way in ways)
    u, v = u - (u.max() + u.min()) / 2, v - (v.max() + v.min()) / 2
    over, along, across = BENDS[bend](u, v, amplitude, np.abs(height).max())
    normal = np.column_stack([-along, -across, np.ones_like(u)])
    normal *= height / np.linalg.norm(normal, axis=1, keepdims=True)
    feet = np.column_stack([u, v, over])
    return (feet + normal) @ rotation.T, (feet - normal) @ rotation.T


KIND = {"straight": "plane", "cylinder": "cylinder"}


def image_errors(mirror, points: Points, images: Points) -> Array:
    errors = np.linalg.norm(mirror.reflect(points) - images, axis=1) / diagonal(points)
    return np.where(np.isnan(errors), np.inf, errors)


def _body(name: str, bend: str, method: str, bars: dict[str, Bar], share: float = 0) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        points, images = body(subject, bend, COUNT, rng)
        result, seconds = timed_detect(noise(points, share, rng), method)
        if result.mirror is None:
            return {"image error": np.inf, "90th": np.inf, "right": 0.0, "seconds": seconds}
        errors = image_errors(result.mirror, points, images)
        right = result.mirror.kind == KIND.get(bend) or np.median(errors) <= NEAR
        return {
            "image error": float(np.median(errors)),
            "90th": float(np.quantile(errors, 0.9, method="nearest")),
            "right": float(right),
            "within 1 %": float((errors <= NEAR).mean()),
            "found": float(result.statistics["verdict"] == "found"),
            "score": result.score,
            "seconds": seconds,
        }

    return Case(f"{method}, bodies, {name}", MESHES, run, bars)


def _residual(points: Points, plane: Plane) -> float:
    """How far images lie from the points, in the median, over the diagonal."""
    found = symsurf.match(points, plane, pair_distance=1, threads=1)
    return float(np.median(found.residuals)) / diagonal(points)


def _straightened(subject: str, rng: np.random.Generator) -> Figures:
    """A body that was bent, straightened over the mirror that is found of it, and as it was."""
    mesh, bend = subject.split()
    points, faces, plane = mirrored_mesh(mesh)
    straight = sampled(points, faces, COUNT, rng)
    shape, _ = bent_body(straight, plane, bend, rng)
    result = symsurf.detect(shape, threads=1)
    if result.mirror is None:
        return {"to unbent": np.inf, "unplaced": 1.0}
    made = symsurf.straighten(shape, result, threads=1)
    placed = np.isfinite(made.shape.points).all(axis=1)
    residual = _residual(made.shape.points[placed], made.plane)
    return {
        "to unbent": residual / _residual(straight, plane),
        "unplaced": float(1 - placed.mean()),
    }


WITHIN = 0.05  # of the diagonal: so far from a pair's foot the mirror is extrapolated
VOXEL = 0.02  # of the diagonal


def _cut(subject: str, rng: np.random.Generator) -> Figures:
    """How much of the mirror has no pairs, told and true, of a body and of one that lacks an end of
    one side."""
    mesh, bend = subject.split()
    points, faces, plane = mirrored_mesh(mesh)
    straight = sampled(points, faces, COUNT, rng)
    shape, images = bent_body(straight, plane, bend, rng)
    feet = plane.project(straight)
    along = (feet - feet.mean(axis=0)) @ rng.normal(size=3)
    side = plane.signed_distance(straight) > 0
    gone = side & (along > np.quantile(along[side], 1 - rng.uniform(0.2, 0.5)))
    told = [
        symsurf.detect(part, method="perpendicular", threads=1).statistics["extrapolated_share"]
        for part in (shape, shape[~gone])
    ]
    # A voxel of the true mirror has evidence where a point on the side that was cut is near.
    size = diagonal(shape)
    middle = (shape + images)[~gone] / 2 / size
    voxels = np.unique(np.floor(middle / VOXEL), axis=0) * VOXEL + VOXEL / 2
    far = KDTree(middle[side[~gone]]).query(voxels)[0] > WITHIN
    return {"whole": told[0], "cut": told[1], "true": far.mean(), "of true": told[1] / far.mean()}


def _bars(median: float, ninth: float) -> dict[str, Bar]:
    return {"image error": at_most(median), "90th": at_most(ninth), "right": at_least(1)}


CASES = tuple(
    _body(f"{bend}{', noise 1 %' if share else ''}", bend, method, bars, share)
    for method, bends in (("auto", ("straight", "cylinder", *BENDS)), ("perpendicular", BENDS))
    for share, bars in ((0.0, _bars(0.004, 0.02)), (0.01, _bars(0.008, 0.04)))
    for bend in bends
) + (
    Case("auto, straightened bodies",
         tuple(f"{mesh} {bend}" for mesh in MESHES for bend in ("cylinder", *BENDS)),
         _straightened, {"to unbent": at_most(2)}),
    Case("perpendicular, cut bodies", tuple(f"{mesh} {bend}" for mesh in MESHES for bend in BENDS),
         _cut, {"whole": at_most(0.01)}),
)  # fmt: skip
