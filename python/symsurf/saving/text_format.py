"""The thesis's output file: figures after #, then the surface points, x,y,z a line; a sphere as
its centre, then its radius on a line of its own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..results import Result


def text_bytes(result: Result) -> bytes:
    lines = [f"# {name} {text}" for name, text in figures(result)]
    if result.mirror is not None and result.mirror.kind == "sphere":
        sphere = result.mirror.numbers
        lines += [coordinates(sphere["centre"]), repr(sphere["radius"])]
    else:
        lines += [coordinates(point) for point in result.surface_points]
    return ("\n".join(lines) + "\n").encode()


def coordinates(point: np.ndarray) -> str:
    return ",".join(map(repr, point.tolist()))


def figures(result: Result) -> Iterator[tuple[str, str]]:
    """What the result says in single figures, as names and texts of one line."""
    yield "method", result.method
    if result.mirror is not None:
        yield "mirror", result.mirror.kind
        yield from _texts(result.mirror.numbers)
    yield "score", repr(result.score)
    yield from _texts(result.statistics)


def _texts(values: dict[str, Any]) -> Iterator[tuple[str, str]]:
    for name, value in values.items():
        if isinstance(value, np.ndarray):
            if value.ndim == 1:
                yield name, coordinates(value)
        else:
            yield name, " ".join(str(value).split())
