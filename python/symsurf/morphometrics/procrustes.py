"""Generalised Procrustes superimposition (Gower 1975; Rohlf and Slice 1990)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Shapes = NDArray[np.float64]
"""(n, k, d) configurations of k landmarks."""

# When gpagen of R's geomorph 4.0 ends: what is compared with it has to end there too.
_TOLERANCE = 1e-4  # of the sum of squares about the mean, at unit centroid size
_MOST_UPDATES = 4  # of the mean


def superimposed(configurations: Shapes) -> Shapes:
    """The configurations at unit centroid size, rotated onto their mean, in the tangent space there.

    Rotations only: none is reflected.
    """
    shapes = scaled(configurations)
    shapes = rotated_onto(shapes[0], shapes)
    scatter = change = _scatter(shapes)
    for _ in range(_MOST_UPDATES):
        if change <= _TOLERANCE:
            break
        shapes = rotated_onto(shapes.mean(axis=0), shapes)
        before, scatter = scatter, _scatter(shapes)
        change = abs(before - scatter)
    return in_tangent_space(unit_mean(shapes), shapes)


def scaled(configurations: Shapes) -> Shapes:
    """Moved to the centroid, divided by the centroid size."""
    centred = configurations - configurations.mean(axis=-2, keepdims=True)
    return centred / centroid_sizes(configurations)[..., None, None]


def centroid_sizes(configurations: NDArray[np.float64]) -> NDArray[np.float64]:
    """(...,) of (..., k, d): the root of the summed squared distances from the centroid."""
    centred = configurations - configurations.mean(axis=-2, keepdims=True)
    return np.linalg.norm(centred, axis=(-2, -1))


def rotated_onto(reference: NDArray[np.float64], shapes: Shapes) -> Shapes:
    """Each rotated as close to the reference (k, d) as it can be, by least squares."""
    u, _, vt = np.linalg.svd(reference.T @ shapes)
    u[..., -1] *= np.sign(np.linalg.det(u @ vt))[:, None]
    return shapes @ (u @ vt).swapaxes(-1, -2)


def in_tangent_space(mean: NDArray[np.float64], shapes: Shapes) -> Shapes:
    """Orthogonal projection: ``x - (x . c) c + c`` about the mean c at unit size (Rohlf 1999)."""
    along = np.tensordot(shapes, mean, axes=2) - 1
    return shapes - along[:, None, None] * mean


def unit_mean(shapes: Shapes) -> NDArray[np.float64]:
    """(k, d)."""
    return scaled(shapes.mean(axis=0)[None])[0]


def _scatter(shapes: Shapes) -> float:
    return len(shapes) * (1 - float((shapes.mean(axis=0) ** 2).sum()))


def is_mirrored(one: Shapes, other: Shapes) -> bool:
    """Whether the others fit those of the same place better when they are reflected."""
    u, lengths, vt = np.linalg.svd(scaled(one).swapaxes(-1, -2) @ scaled(other))
    return float((np.linalg.det(u @ vt) * lengths[:, -1]).sum()) < 0


def reflected(shapes: Shapes) -> Shapes:
    """Over the plane, or line, x = 0."""
    return shapes * np.where(np.arange(shapes.shape[-1]) == 0, -1.0, 1.0)
