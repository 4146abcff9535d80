"""What the score does when the object stays: over sampling, under noise, with half of it gone."""

from __future__ import annotations

import numpy as np

import symsurf
from symsurf import Plane

from .cad import KINDS, cad_mesh
from .case import Case, Figures, at_least, at_most, timed_detect
from .damage import noise
from .pieces import Mesh
from .planes import difference
from .poses import Points, random_rotation, turned
from .solids import FILES, FOLDER, mirrored_mesh, sampled

COUNT = 4096
SIZES = (1000, 3000, 10_000, 30_000, 100_000)
NOISES = (0, 0.003, 0.01)


def _mesh(shape: str, rng: np.random.Generator) -> Mesh:
    if shape == "CAD":
        return cad_mesh(str(rng.choice(list(KINDS))), rng)
    if shape == "skull":
        skull = symsurf.read(FOLDER / FILES[shape][0])
        return skull.points, skull.faces
    return mirrored_mesh(shape)[:2]


def _drawn(subject: str, rng: np.random.Generator) -> list[Points]:
    """The shape at all SIZES, in one pose: samples of the surface, or some of the "vertices"."""
    vertices, faces = _mesh(subject.split()[0], rng)
    vertices = vertices @ random_rotation(rng).T
    if subject.endswith("vertices"):
        return [vertices[rng.permutation(len(vertices))[:size]] for size in SIZES]
    return [sampled(vertices, faces, size, rng) for size in SIZES]


def _drift(method: str, subjects: tuple[str, ...], trials: int) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        figures: dict[str, float] = {}
        times = []
        for size, points in zip(SIZES, _drawn(subject, rng)):
            result, seconds = timed_detect(points, method)
            figures[f"score, {size}"] = result.score
            if method == "auto" and size >= 10_000:
                times.append(seconds / timed_detect(points, "plane")[1])
        scores = list(figures.values())
        if times:
            figures["times plane"] = max(times)
        return {"drift": max(scores) - min(scores), **figures, f"seconds, {SIZES[-1]}": seconds}

    bars = {"drift": at_most(0.05)}
    if method == "auto":
        bars |= {"times plane": at_most(3), f"seconds, {SIZES[-1]}": at_most(0.5)}
    return Case(f"{method}, one shape, {SIZES[0]} to {SIZES[-1]}", subjects, run, bars, trials)


def _noisier(method: str) -> Case:
    """How far more noise raises the score, over that of the clean shape and of any with less."""

    def run(subject: str, rng: np.random.Generator) -> Figures:
        vertices, faces = _mesh(subject.split()[0], rng)
        points = vertices if "vertices" in subject else sampled(vertices, faces, COUNT, rng)
        points = points @ random_rotation(rng).T
        scores = [timed_detect(noise(points, s, rng), method)[0].score for s in NOISES]
        least_before = np.minimum.accumulate(scores)[:-1]
        names = [f"score, {share:.1%}" for share in NOISES]
        return {"over clean": max(scores[1:]) - scores[0], "rise": max(scores[1:] - least_before),
                **dict(zip(names, scores))}  # fmt: skip

    bars = {"over clean": at_most(0.01), "rise": at_most(0.01)}
    subjects = ("airplane", "airplane vertices", "ant")
    return Case(f"{method}, more and more noise", subjects, run, bars)


def _half(method: str) -> Case:
    """Cut off at its plane of symmetry: nothing is left of the mirror but, at best, its place."""

    def run(subject: str, rng: np.random.Generator) -> Figures:
        vertices, faces, plane = mirrored_mesh(subject.split()[0])
        rotation = random_rotation(rng)
        points = sampled(vertices, faces, 2 * COUNT, rng)
        signed = plane.signed_distance(points) * rng.choice([-1, 1])
        points, plane = points[signed > 0] @ rotation.T, turned(plane, rotation)
        result, seconds = timed_detect(points, method)
        none = result.statistics["verdict"] == "none"
        right = False
        if isinstance(result.mirror, Plane):
            angle, offset = difference(result.mirror, plane, points)
            right = angle <= 5 and offset <= 0.03
        return {"none or right": float(none or right), "verdict none": float(none),
                "score": result.score, "seconds": seconds}  # fmt: skip

    bars = {"none or right": at_least(1)}
    return Case(f"{method}, half an object", ("airplane half",), run, bars)


_SHAPES = ("airplane", "ant", "cow", "CAD", "skull", "skull vertices")

CASES = (
    _drift("plane", _SHAPES, 10),
    _drift("auto", _SHAPES, 5),
    *(_noisier(method) for method in ("plane", "auto")),
    *(_half(method) for method in ("plane", "auto")),
)
