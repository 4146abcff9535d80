"""The thesis's output file: figures after #, then the surface points, x,y,z a line; a sphere as
its centre, then its radius on a line of its own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .._core import Sphere
from ..reading.json_records import MIDPOINT_METHODS
from ..results import Result


def text_bytes(result: Result) -> bytes:
    lines = [f"# {line}" for line in comments(result)]
    sphere = (
        result.method not in MIDPOINT_METHODS
        and isinstance(result.mirror, Sphere)
        and result.mirror
    )
    if sphere:
        lines += [coordinates(sphere.centre), repr(sphere.radius)]
    else:
        lines += [coordinates(point) for point in result.surface_points]
    return ("\n".join(lines) + "\n").encode()


def coordinates(point: np.ndarray) -> str:
    return ",".join(map(repr, point.tolist()))


def comments(result: Result) -> Iterator[str]:
    """The axes, and what the result says in single figures: lines of a name and a text."""
    if result.space:
        yield f"SPACE={result.space}"
    yield f"method {result.method}"
    if result.mirror is not None:
        yield f"mirror {result.mirror.kind}"
        yield from _figures(result.mirror.numbers)
    yield f"score {result.score!r}"
    yield from _figures(result.statistics)


def _figures(values: dict[str, Any]) -> Iterator[str]:
    for name, value in values.items():
        if isinstance(value, np.ndarray):
            if value.ndim == 1:
                yield f"{name} {coordinates(value)}"
        else:
            yield " ".join([name, *str(value).split()])
