"""Results and mirrors from JSON."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, InvalidParameter, Mirror, make_mirror
from .errors import reason_of

MIDPOINT_METHODS = ("separation", "separation_normals", "normals_only")
"""Methods of the thesis that end with midpoints, scattered about the mirror that lies through them."""


_CHECKED = 200  # surface points of a large result, of all alike
# What statistics were called before 0.2.0.
_RENAMED = {"stray_points": "outliers", "skin_points": "boundary_points"}
_ROUNDING = 1e-6  # of the largest coordinate: far above that of any mirror's foot


def result_fields(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The fields of a result that was saved, by name; see ``Result.load``."""
    path = Path(path)
    if path.suffix.lower() != ".json":
        raise InvalidParameter(f"path is {str(path)!r}; allowed is the suffix .json")
    with content_of(path, "no result that was saved") as record:
        footprint = record.get("footprint")  # older versions wrote none
        candidates = [_fields(each, footprint, []) for each in record.get("candidates", [])]
        fields = _fields(record, footprint, candidates) | {"space": _space(record.get("space"))}
        _require_sound(fields)
        return fields


@contextmanager
def content_of(path: Path, what: str) -> Iterator[Any]:
    """What a JSON file holds. Raises InvalidInput, naming the file, for one that cannot be read, and
    for whatever its content does to the code within: any value may stand where another should.

    Args:
        what: the reason, in words such as "not the truth of a sample".
    """
    import json  # `import symsurf` does not wait for it

    try:
        content = json.loads(path.read_text())
    except OSError as error:
        raise InvalidInput(f"{path}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise InvalidInput(f"{path}: no JSON ({error})") from error
    try:
        yield content
    except MemoryError:
        raise
    except Exception as error:
        kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
        reason = " ".join(reason_of(error).split())
        raise InvalidInput(f"{path}: {what} ({kind}{reason})") from error


def mirror_from(record: dict[str, Any], footprint: Any = None) -> Mirror:
    """The mirror of what ``mirror_record`` gave. Raises InvalidInput, KeyError or TypeError."""
    numbers = {name: _value(value) for name, value in record.items() if name != "kind"}
    return make_mirror(record["kind"], numbers, footprint)


def read_mirror(path: Path) -> Mirror:
    """The mirror of a result or of its summary, or one that is written by hand in their form. Raises
    InvalidInput, which names the file."""
    with content_of(path, 'no "mirror" with its kind and numbers') as record:
        return mirror_from(record["mirror"], record.get("footprint"))


def _require_sound(fields: dict[str, Any]) -> None:
    """Raises InvalidInput where the fields are not those of one result."""
    names = ("pairs", "residuals", "surface_points", "mirror", "candidates")
    pairs, residuals, points, mirror, candidates = (fields[name] for name in names)
    if residuals.ndim != 1 or len(residuals) != len(points) or len(pairs) not in (0, len(points)):
        raise InvalidInput(
            f"there are {len(pairs)} pairs, {residuals.size} residuals and {len(points)} surface points"
        )
    if not np.isfinite(points).all() or not (np.isfinite(residuals) & (residuals >= 0)).all():
        raise InvalidInput("a surface point is not finite, or a residual below 0 or not finite")
    if pairs.size and pairs.min() < 0:
        raise InvalidInput(f"a pair names point {pairs.min()}; allowed are indices from 0 on")
    for each in (fields, *candidates):
        if not 0 <= each["score"] <= 1:
            raise InvalidInput(f"score is {each['score']}; allowed is 0 to 1")
        if not 0 <= each["seconds"] < float("inf"):
            raise InvalidInput(f"seconds is {each['seconds']}; allowed is [0, inf)")
    if not len(points):
        return
    some = slice(None, None, max(1, len(points) // _CHECKED))
    scale = float(np.abs(points).max())
    if mirror is not None and fields["method"] not in MIDPOINT_METHODS:
        with np.errstate(over="ignore"):
            moved = np.linalg.norm(mirror.reflect(points[some]) - points[some], axis=1)
        if not (moved <= residuals[some] + _ROUNDING * scale).all():
            raise InvalidInput("the mirror does not run through the surface points")
    for other in (candidate["mirror"] for candidate in candidates):
        if other is not None and not np.isfinite(other.reflect(points[some])).any():
            raise InvalidInput("a candidate has an image of no surface point")


def _fields(
    record: dict[str, Any], footprint: Any, candidates: list[dict[str, Any]]
) -> dict[str, Any]:
    mirror = record["mirror"]
    return {
        "method": _text("method", record["method"]),
        "mirror": None if mirror is None else mirror_from(mirror, footprint),
        "surface_points": np.array(record.get("surface_points", []), np.float64).reshape(-1, 3),
        "pairs": pairs_from(record.get("pairs", [])),
        "residuals": np.array(record.get("residuals", []), dtype=np.float64),
        "score": _real("score", record["score"]),
        "candidates": candidates,
        "parameters": _values(record.get("parameters", {})),
        "statistics": {
            _RENAMED.get(name, name): value
            for name, value in _values(record.get("statistics", {})).items()
        },
        "seconds": _real("seconds", record.get("seconds", 0.0)),
    }


def pairs_from(values: Any) -> NDArray[np.int64]:
    """Pairs (m, 2) of a list. Raises InvalidInput, or ValueError for rows of another length."""
    rows = np.array(values)
    if rows.size and rows.dtype.kind != "i":
        raise InvalidInput("pairs are not all indices; allowed are whole numbers of 64 bits")
    return rows.astype(np.int64).reshape(-1, 2)


def _values(record: dict[str, Any]) -> dict[str, Any]:
    return {name: _value(value) for name, value in record.items()}


def _value(value: Any) -> Any:
    return np.array(value, dtype=np.float64) if isinstance(value, list) else _number(value)


def _text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise InvalidInput(f"{name} is {value!r:.40}; allowed is a word")
    return value


def _space(value: Any) -> str | None:
    if value not in (None, "RAS", "LPS"):
        raise InvalidInput(f"space is {value!r:.40}; allowed are 'RAS', 'LPS' and null")
    return value


def _real(name: str, value: Any) -> float:
    number = _number(value)
    if isinstance(number, bool) or not isinstance(number, (int, float)):
        raise InvalidInput(f"{name} is {number!r:.40}; allowed is a number")
    return float(number)


def _number(value: Any) -> Any:
    """What is not finite is written as null."""
    return float("nan") if value is None else value
