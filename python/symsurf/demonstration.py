"""Real meshes with a known mirror plane, whole and damaged, and how well it is found."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ._core import Plane
from .detection import detect
from .result import Result
from .shape import Shape, read


@dataclass(frozen=True)
class Case:
    """A shape, what was done to it, and its true mirror."""

    name: str
    damage: str
    shape: Shape
    truth: Plane


@dataclass(frozen=True)
class Finding:
    """How the mirror found in a case compares with the true one."""

    case: Case
    result: Result
    angle: float
    """Between the normals, degrees; NaN where no plane was found, as is the offset."""
    offset: float
    """Between the planes at the centre of the points, % of the diagonal."""


def cases() -> Iterator[Case]:
    """The meshes that PyVista ships, as they are, turned, and damaged and turned."""
    from pyvista import examples

    # Both are modelled mirrored in x: the ant about 0, the airplane about half its span.
    for name, path in {"ant": examples.antfile, "airplane": examples.planefile}.items():
        shape = read(Path(path))
        x = shape.points[:, 0]
        truth = Plane((1, 0, 0), -(x.min() + x.max()) / 2)
        rng = np.random.default_rng(len(x))
        noisy = add_noise(shape, 0.01, rng)
        yield Case(name, "as it is", shape, truth)
        yield moved(Case(name, "turned", shape, truth), rng)
        yield moved(Case(name, "1 % noise", noisy, truth), rng)
        yield moved(Case(name, "20 % removed", remove_part(shape, 0.2), truth), rng)
        yield moved(Case(name, "noise and removed", remove_part(noisy, 0.2), truth), rng)


def find(case: Case) -> Finding:
    result = detect(case.shape.points, "plane")
    found, truth = result.mirror, case.truth
    if not isinstance(found, Plane):
        return Finding(case, result, angle=float("nan"), offset=float("nan"))
    centre = case.shape.points.mean(axis=0, keepdims=True)
    sign = 1 if found.normal @ truth.normal >= 0 else -1
    gap = found.signed_distance(centre)[0] - sign * truth.signed_distance(centre)[0]
    sine = np.linalg.norm(np.cross(found.normal, truth.normal))
    cosine = abs(found.normal @ truth.normal)
    return Finding(
        case,
        result,
        angle=float(np.degrees(np.arctan2(sine, cosine))),
        offset=100 * abs(gap) / diagonal(case.shape.points),
    )


def diagonal(points: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def add_noise(shape: Shape, share: float, rng: np.random.Generator) -> Shape:
    """Normally distributed noise in all directions; share of the diagonal."""
    noise = rng.normal(scale=share * diagonal(shape.points), size=shape.points.shape)
    return Shape(shape.points + noise, shape.faces)


def remove_part(shape: Shape, share: float) -> Shape:
    """Without the points nearest to the one that is farthest out in x."""
    points = shape.points
    distances = np.linalg.norm(points - points[points[:, 0].argmax()], axis=1)
    kept = distances > np.quantile(distances, share)
    if shape.faces is None:
        return Shape(points[kept])
    faces = shape.faces[kept[shape.faces].all(axis=1)]
    return Shape(points[kept], (np.cumsum(kept) - 1)[faces])


def moved(case: Case, rng: np.random.Generator) -> Case:
    """The case turned at random about the origin."""
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    shape = Shape(case.shape.points @ rotation.T, case.shape.faces)
    return Case(
        case.name, case.damage, shape, Plane(rotation @ case.truth.normal, case.truth.offset)
    )
