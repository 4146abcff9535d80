"""``plane`` on CAD-like meshes, by the measure of public benchmarks, beside multi-start ICP."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from symsurf import Plane

from .cad import KINDS, cad_mesh
from .case import Case, Figures, at_least, at_most, timed_detect
from .icp import multi_start_icp
from .poses import diagonal, random_rotation
from .solids import sampled

COUNT = 4096
DENSE = 65536
"""Samples that stand for the surface: their spacing adds less than 0.05e-4 to the error."""
AS_NEAR = 0.05
"""What the error may exceed another by, in the same unit: a tenth of what benchmarks allow."""
ALLOWED = 0.5


def _trial(subject: str, rng: np.random.Generator) -> Figures:
    vertices, faces = cad_mesh(subject, rng)
    rotation = random_rotation(rng)
    vertices = vertices @ rotation.T
    points = sampled(vertices, faces, COUNT, rng)
    surface = KDTree(sampled(vertices, faces, DENSE, rng))

    def error(plane: Plane) -> float:
        """Mean squared distance of reflected samples, 1e-4 of the squared diagonal."""
        distances = surface.query(plane.reflect(points))[0] / diagonal(points)
        return 1e4 * float((distances**2).mean())

    result, seconds = timed_detect(points, "plane")
    found = error(result.mirror) if result.mirror else np.inf
    icp = error(multi_start_icp(points, rng))
    truth = error(Plane(rotation[:, 0], 0.0))
    return {
        "as near as ICP": float(found <= icp + AS_NEAR),
        "as near as truth": float(found <= truth + AS_NEAR),
        "within 0.5e-4": float(found <= ALLOWED),
        "ICP within": float(icp <= ALLOWED),
        "error, 1e-4": found,
        "score": result.score,
        "seconds": seconds,
    }


CASES = (
    Case("plane, CAD-like meshes", tuple(KINDS), _trial,
         {"as near as ICP": at_least(0.99), "seconds": at_most(0.02)}, trials=55),
)  # fmt: skip
