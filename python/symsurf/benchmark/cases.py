"""The cases, made when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import InvalidParameter

SIZES = {"small": 2_000, "medium": 10_000, "large": 100_000}
"""Points of each case."""


class BenchmarkSample(NamedTuple):
    """A case of the benchmark with its truth."""

    name: str
    shape: str
    """"creature", "head", "part", "mask" or "sheets"."""
    bend: str
    """"straight", "bent", "domed", "waved", "twisted", or "none": there is no mirror."""
    damage: str
    """"exact", "clean", "noise-0.5", "noise-1", "noise-2", "hole", "half" or "density"."""
    asymmetry: float
    """Root mean square of a smooth displacement, over the diagonal."""
    points: NDArray[np.float64]
    """(n, 3)"""
    images: NDArray[np.float64] | None
    """(n, 3): of the points over the true mirror; None without a mirror."""
    partners: NDArray[np.int64]
    """(n,): the row that a point's image is; -1 where the image is no point."""
    diagonal: float
    """Of the bounding box before damage: the unit of all errors."""
    kind: str
    """Of the true mirror: "plane", "cylinder", "sphere", "graph" or "none"."""
    mirror: dict[str, Any]
    """Its numbers; see docs/curved_benchmark.md."""


def case_names(patterns: Sequence[str] = ("*",)) -> list[str]:
    """The cases that match one of the patterns, such as ``head-*-noise-1``.

    Raises InvalidParameter for a pattern that no case matches.
    """
    cases = [case.name for case in _core.benchmark_cases()]
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in cases):
            raise InvalidParameter(
                f"cases has {pattern!r}, which none of the {len(cases)} cases matches, as "
                f"{cases[0]!r} or {cases[-1]!r} would"
            )
    return [name for name in cases if any(fnmatchcase(name, pattern) for pattern in patterns)]


def points_of_size(size: str) -> int:
    """Raises InvalidParameter for an unknown size."""
    if size not in SIZES:
        raise InvalidParameter(f"size is {size!r}; allowed are {', '.join(SIZES)}")
    return SIZES[size]


def benchmark(
    size: str = "medium", seed: int = 0, cases: Sequence[str] = ("*",)
) -> Iterator[BenchmarkSample]:
    """The cases of the benchmark of curved mirrors, each made when it is asked for.

    The same seed gives the same bits from one build of symsurf, such as a wheel.

    Args:
        size: "small", "medium" or "large": 2,000, 10,000 or 100,000 points.
        seed: of shapes, poses and points; another seed gives other ones.
        cases: names or patterns of names, such as ``head-*-noise-1``.

    Raises:
        InvalidParameter: an unknown size, a pattern that no case matches, a seed that is no whole
            number of at least 0.
    """
    count, names = points_of_size(size), case_names(cases)
    described = {case.name: case for case in _core.benchmark_cases()}
    _core.benchmark_sample(names[0], 100, seed)  # refuses a seed at once
    return (_sample(described[name], count, seed) for name in names)


def _sample(case: _core.BenchmarkCase, count: int, seed: int) -> BenchmarkSample:
    points, images, partners, diagonal, kind, mirror = _core.benchmark_sample(
        case.name, count, seed
    )
    return BenchmarkSample(
        case.name,
        case.shape,
        case.bend,
        case.damage,
        case.asymmetry,
        points,
        images if len(images) else None,
        np.array(partners, dtype=np.int64),
        diagonal,
        kind,
        mirror,
    )
