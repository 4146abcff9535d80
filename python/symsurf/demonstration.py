"""Real meshes with a known mirror, as they are and changed: how well it is found, and what is done
with it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ._core import Cylinder, Mirror, Plane
from .base.optional import require
from .base.progress import Progress
from .detection import detect
from .mirror_operations.operate import operate
from .reading import read
from .results import OperationResult, Result
from .shapes import Shape

BEND = 0.8  # of the diagonal: the radius that a shape is bent over
NOISE = 0.01  # of the diagonal: its standard deviation in each direction
CUT = 0.15  # of the half width: where one side is cut off; the airplane loses its wing
RAISED = 0.03  # of the diagonal: how far the tip of one side is


@dataclass(frozen=True)
class Case:
    """A shape, what was done to it, and its true mirror."""

    name: str
    change: str
    shape: Shape
    truth: Mirror
    before: Shape
    """The shape that was changed."""


@dataclass(frozen=True)
class Finding:
    """How the mirror found in a case compares with the true one."""

    case: Case
    result: Result
    error: float
    """Between the images of the points over both, root mean square, % of the diagonal; NaN where no
    mirror was found."""


@dataclass(frozen=True)
class Deed:
    """What was done with the mirror of a case."""

    case: Case
    result: OperationResult
    figure: str
    """What is measured."""
    value: float
    """% of the diagonal."""
    truth: float
    """What it should be."""


def cases() -> Iterator[Case]:
    """The meshes that PyVista ships, straight and bent, and one of them damaged."""
    require("the demonstration's meshes", "pyvista")
    from pyvista import examples

    # Both are modelled mirrored in x: the ant about 0, the airplane about half its span. The ant's
    # sides differ by 0.5 % of the diagonal.
    for name, path in {"ant": examples.antfile, "airplane": examples.planefile}.items():
        whole = read(Path(path))
        rng = np.random.default_rng(len(whole.points))
        straight = Case(name, "as it is", whole, middle(whole), whole)
        yield straight
        yield turned(straight, rng)
        yield bent(straight)
    yield turned(replace(straight, change="noisy", shape=add_noise(whole, NOISE, rng)), rng)
    yield turned(replace(straight, change="one side cut off", shape=cut_off(whole, CUT)), rng)
    yield replace(straight, change="one tip raised", shape=raise_tip(whole))


def find(case: Case, progress: Progress | None = None) -> Finding:
    """By the default call."""
    # Thin wings mostly slide over themselves: with a tip raised, little tells of the plane.
    result = detect(case.shape, progress=progress)
    error = float("nan")
    if result.mirror is not None:
        points = case.shape.points
        gaps = np.linalg.norm(
            result.mirror.reflect(points) - case.truth.reflect(points), axis=1
        ) / diagonal(case.shape)
        error = 100 * float(np.sqrt(np.nanmean(gaps**2)))
    return Finding(case, result, error)


def deeds(finding: Finding) -> Iterator[Deed]:
    """What a case is there to show."""
    case, found = finding.case, finding.result
    unit = 100 / diagonal(case.before)
    if found.verdict != "found":
        return
    if case.change == "one tip raised":
        measured = operate("asymmetry", case.shape, found)
        farthest = unit * float(measured.statistics["maximum"])
        yield Deed(case, measured, "asymmetry at the most", farthest, 100 * RAISED)
    elif case.change == "one side cut off":
        whole = operate("complete", case.shape, found)
        missed = unit * _missed(case.before, whole.shape)
        yield Deed(case, whole, "95 % of what was there is as near as", missed, 0)
    elif case.change == "bent":
        straight = operate("straighten", case.shape, found)
        off = unit * _difference_in_shape(straight.shape.points, case.before.points)
        yield Deed(case, straight, "difference from the mesh before, rms", off, 0)


def draw(findings: Sequence[Finding], deeds: Sequence[Deed], folder: Path) -> Iterator[Path]:
    """Writes the pictures, naming each when it is there."""
    for finding in findings:
        path = folder / f"{file_name(finding.case)}.png"
        finding.result.plot(path, shape=finding.case.shape)
        yield path
    for deed in deeds:
        path = folder / f"{file_name(deed.case)}-{deed.result.operation}.png"
        deed.result.plot(path)
        yield path


def file_name(case: Case) -> str:
    return f"{case.name} {case.change}".replace(" ", "-")


def diagonal(shape: Shape) -> float:
    return float(np.linalg.norm(np.ptp(shape.points, axis=0)))


def middle(shape: Shape) -> Plane:
    """The plane across x halfway between the extremes."""
    x = shape.points[:, 0]
    return Plane((1, 0, 0), -(x.min() + x.max()) / 2)


def add_noise(shape: Shape, share: float, rng: np.random.Generator) -> Shape:
    """Normally distributed noise in all directions; share of the diagonal."""
    noise = rng.normal(scale=share * diagonal(shape), size=shape.points.shape)
    return Shape(shape.points + noise, shape.faces)


def cut_off(shape: Shape, share: float) -> Shape:
    """Without what lies further out in x than that share of the half width, on one side."""
    x = shape.points[:, 0]
    kept = x < (x.max() + x.min()) / 2 + share * (x.max() - x.min()) / 2
    assert shape.faces is not None
    faces = shape.faces[kept[shape.faces].all(axis=1)]
    return Shape(shape.points[kept], (np.cumsum(kept) - 1)[faces])


def raise_tip(shape: Shape) -> Shape:
    """Lifts what lies farthest out in x along z, gently."""
    x = shape.points[:, 0]
    out = (x - x.mean()) / (x.max() - x.mean())
    weight = np.clip((out - 0.5) / 0.5, 0, 1)
    lift = RAISED * diagonal(shape) * weight**2 * (3 - 2 * weight)
    return Shape(shape.points + lift[:, None] * (0, 0, 1), shape.faces)


def bent(case: Case) -> Case:
    """Rolled along y over a cylinder that touches the mirror along z."""
    points, radius = case.shape.points, BEND * diagonal(case.shape)
    x, y, z = points.T
    centre = np.array([-float(case.truth.numbers["offset"]) - radius, y.mean(), 0])
    angle, height = (y - y.mean()) / radius, x - centre[0]
    rolled = [centre[0] + height * np.cos(angle), y.mean() + height * np.sin(angle), z]
    truth = Cylinder(centre, (0, 0, 1), radius)
    shape = Shape(np.column_stack(rolled), case.shape.faces)
    return replace(case, change="bent", shape=shape, truth=truth)


def turned(case: Case, rng: np.random.Generator) -> Case:
    """The case turned at random about the origin; its mirror is a plane."""
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    before = Shape(case.before.points @ rotation.T, case.before.faces)
    shape = Shape(case.shape.points @ rotation.T, case.shape.faces)
    normal, offset = case.truth.numbers["normal"], case.truth.numbers["offset"]
    change = "turned" if case.change == "as it is" else case.change
    return replace(
        case, change=change, shape=shape, truth=Plane(rotation @ normal, offset), before=before
    )


def _missed(whole: Shape, completed: Shape) -> float:
    """How near 95 % of the whole shape's points are to the completed surface."""
    import pyvista

    surface = pyvista.PolyData.from_regular_faces(completed.points, completed.faces)
    measured = pyvista.PolyData(whole.points).compute_implicit_distance(surface)
    return float(np.percentile(np.abs(measured["implicit_distance"]), 95))


def _difference_in_shape(points: NDArray[np.float64], others: NDArray[np.float64]) -> float:
    """Root mean square, after the turn and shift that make it least."""
    points, others = points - points.mean(axis=0), others - others.mean(axis=0)
    left, _, right = np.linalg.svd(points.T @ others)
    return float(np.sqrt(((points @ left @ right - others) ** 2).sum(axis=1).mean()))
