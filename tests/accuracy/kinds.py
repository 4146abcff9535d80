"""``auto``: cylinders for bent objects, planes for straight ones, nothing for blobs."""

from __future__ import annotations

import numpy as np

import symsurf
from symsurf import Cylinder, Mirror

from .case import Case, Figures, at_least, at_most, timed_detect
from .damage import noise
from .poses import Points, diagonal, random_rotation, turned
from .solids import ASYMMETRIC, FILES, FOLDER, MESHES, asymmetric, bent, mirrored_mesh, sampled

COUNT = 4096
BENT_FILES = {"bent cow": 2.5769, "bent capsule": 2.5}


def _choice(points: Points, truth: Mirror, rng: np.random.Generator) -> Figures:
    rotation = random_rotation(rng)
    points, truth = points @ rotation.T, turned(truth, rotation)
    result, seconds = timed_detect(points, "auto")
    plane = truth.kind == "plane"
    chosen = result.mirror is not None and (result.mirror.kind == "plane") == plane
    feet = result.mirror.project(points) if result.mirror else np.full((1, 3), np.nan)
    distances = np.abs(truth.signed_distance(feet[np.isfinite(feet).all(axis=1)]))
    error = float(np.quantile(distances, 0.95)) / diagonal(points) if len(distances) else np.inf
    return {
        "distance": error,
        "right kind": float(chosen),
        "verdict found": float(result.statistics["verdict"] == "found"),
        "score": result.score,
        "seconds": seconds,
    }


def _bent_file(subject: str, rng: np.random.Generator) -> Figures:
    radius = BENT_FILES[subject]
    shape = symsurf.read(FOLDER / FILES[subject][0])
    return _choice(shape.points, Cylinder((-radius, 0, 0), (0, 1, 0), radius), rng)


def _bent_mesh(subject: str, rng: np.random.Generator) -> Figures:
    points, faces, plane = mirrored_mesh(subject)
    points, cylinder = bent(sampled(points, faces, COUNT, rng), plane, rng.uniform(0.8, 1.6))
    return _choice(points, cylinder, rng)


def _straight_mesh(share: float):
    def run(subject: str, rng: np.random.Generator) -> Figures:
        points, faces, plane = mirrored_mesh(subject)
        return _choice(noise(sampled(points, faces, COUNT, rng), share, rng), plane, rng)

    return run


def _blob(subject: str, rng: np.random.Generator) -> Figures:
    points = asymmetric(subject, int(rng.choice((1000, 2000, 4000))), rng)
    result, seconds = timed_detect(points, "auto")
    verdict = float(result.statistics["verdict"] == "none")
    return {"verdict none": verdict, "score": result.score, "seconds": seconds}


_KIND = {"distance": at_most(0.005), "right kind": at_least(1)}

CASES = (
    Case("auto, bent files", tuple(BENT_FILES), _bent_file, _KIND),
    Case("auto, bent meshes", MESHES, _bent_mesh, _KIND),
    Case("auto, straight meshes", MESHES, _straight_mesh(0), _KIND),
    Case("auto, straight meshes, noise 1 %", MESHES, _straight_mesh(0.01), _KIND),
    Case("auto, blobs", ASYMMETRIC, _blob, {"verdict none": at_least(0.96)}),
)
