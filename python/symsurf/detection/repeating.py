"""How well a mirror repeats: standard deviations over measurements of one part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import InvalidParameter, Mirror

_MOST = 10_000
_COMPARED = 200  # points that tell mirrors apart
_STEP = 1e-4  # of the extent: the differences of distances are exact to its square


class Measurement(NamedTuple):
    """The mirror of one measurement of a part."""

    mirror: Mirror | None
    score: float
    rms: float = np.nan
    """Root mean square asymmetry, input units."""


def require_repeat(repeat: int) -> None:
    """Raises InvalidParameter unless it is 0, for none, or a number that has a deviation."""
    if repeat != 0 and not 2 <= repeat <= _MOST:
        raise InvalidParameter(f"repeat is {repeat!r}; allowed is 0 or [2, {_MOST}]")


def half_samples(
    points: NDArray[np.float64],
    repeat: int,
    mirror: Mirror | None,
    *,
    method: str,
    parameters: dict[str, Any],
    seed: int,
    threads: int,
) -> Iterator[tuple[NDArray[np.int64], Measurement]]:
    """Random halves of the finite points, and their mirrors: these scatter at least as those of whole
    measurements do, if the errors of the points are independent (the half-sampling jackknife, Shao and
    Wu 1989). Of 1,500 and 4,000 points twice and 1.4 times as far: the mirrors of fewer points scatter
    more than by the root of their number."""
    random = np.random.default_rng(seed)
    finite = np.flatnonzero(np.isfinite(points).all(axis=1))
    for _ in range(repeat):
        rows = np.sort(random.permutation(finite)[: len(finite) // 2])
        half = np.ascontiguousarray(points[rows], dtype=float)
        made = _core.detect(half, None, method, None, False, seed, threads, None, parameters)
        found = [made, *made["candidates"]]
        yield rows, closest([Measurement(e["mirror"], e["score"]) for e in found], mirror, half)


def closest(
    found: Sequence[Measurement], mirror: Mirror | None, points: NDArray[np.float64]
) -> Measurement:
    """That of the mirrors of one measurement which is the same as another's: a part may have several
    that score alike. The first where none is given, or found."""
    sample = points[:: max(1, len(points) // _COMPARED)]

    def apart(each: Measurement) -> float:
        if each.mirror is None or mirror is None:
            return np.inf
        own, other = each.mirror.signed_distance(sample), mirror.signed_distance(sample)
        return min(float(np.nanmean(np.square(own + sign * other))) for sign in (1, -1))

    return min(found, key=apart)


def deviations(measurements: Sequence[Measurement], points: NDArray[np.float64]) -> dict[str, Any]:
    """Standard deviations over at least two measurements of a part with these points, by name:
    "angle_sd" of the mirror's normal from its mean, degrees; "offset_sd" of its distance from the
    centroid and "rms_sd" of the asymmetry, input units; "score_sd"; and "repeats", how many had a
    mirror. Over a curved mirror both are those of its foot below the centroid."""
    found = [each for each in measurements if each.mirror is not None]
    figures: dict[str, Any] = {"repeats": len(found)}
    if len(found) < 2:
        return figures
    finite = points[np.isfinite(points).all(axis=1)]
    centre, step = finite.mean(axis=0), _STEP * float(np.ptp(finite, axis=0).max())
    around = centre + step * np.vstack([np.zeros(3), np.eye(3), -np.eye(3)])
    heights = np.array([each.mirror.signed_distance(around) for each in found if each.mirror])
    normals = heights[:, 1:4] - heights[:, 4:]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    signs = np.where(normals @ normals[0] < 0, -1, 1)
    normals *= signs[:, None]
    mean = normals.mean(axis=0)
    angles = np.arctan2(np.linalg.norm(np.cross(normals, mean), axis=1), normals @ mean)
    made = {
        "angle_sd": np.degrees(np.sqrt(np.square(angles).sum() / (len(found) - 1))),
        "offset_sd": (signs * heights[:, 0]).std(ddof=1),
        "score_sd": np.std([each.score for each in found], ddof=1),
        "rms_sd": np.std([each.rms for each in found], ddof=1),
    }
    return figures | {name: float(value) for name, value in made.items() if np.isfinite(value)}
