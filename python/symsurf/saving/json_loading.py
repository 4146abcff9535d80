"""Results and mirrors from JSON."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, InvalidParameter, Mirror, make_mirror
from ..result import Result


def load(path: str | os.PathLike[str]) -> Result[Mirror]:
    """See ``Result.load``."""
    path = Path(path)
    if path.suffix.lower() != ".json":
        raise InvalidParameter(f"path is {str(path)!r}; allowed is the suffix .json")
    with content_of(path, "no result that was saved") as record:
        return _result(record)


@contextmanager
def content_of(path: Path, what: str) -> Iterator[Any]:
    """What a JSON file holds. Raises InvalidInput, naming the file, for one that cannot be read, and
    for whatever its content does to the code within: any value may stand where another should.

    Args:
        what: the reason, in words such as "not the truth of a sample".
    """
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
        reason = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
        raise InvalidInput(f"{path}: {what} ({' '.join(reason.split())})") from error


def mirror_from(record: dict[str, Any], footprint: Any = None) -> Mirror:
    """The mirror of what ``mirror_record`` gave. Raises InvalidInput, KeyError or TypeError."""
    numbers = {name: _value(value) for name, value in record.items() if name != "kind"}
    return make_mirror(record["kind"], numbers, footprint)


def _result(record: dict[str, Any]) -> Result[Mirror]:
    footprint = record["footprint"]
    candidates = [_found(each, footprint) for each in record["candidates"]]
    return _found(record, footprint, candidates)


def _found(
    record: dict[str, Any], footprint: Any, candidates: list[Result[Mirror]] | None = None
) -> Result[Mirror]:
    mirror = record["mirror"]
    return Result(
        method=_text("method", record["method"]),
        mirror=None if mirror is None else mirror_from(mirror, footprint),
        surface_points=np.array(record.get("surface_points", []), np.float64).reshape(-1, 3),
        pairs=pairs_from(record.get("pairs", [])),
        residuals=np.array(record.get("residuals", []), dtype=np.float64),
        score=_real("score", record["score"]),
        candidates=candidates or [],
        parameters=_values(record.get("parameters", {})),
        statistics=_values(record.get("statistics", {})),
        seconds=_real("seconds", record.get("seconds", 0.0)),
    )


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


def _real(name: str, value: Any) -> float:
    number = _number(value)
    if isinstance(number, bool) or not isinstance(number, (int, float)):
        raise InvalidInput(f"{name} is {number!r:.40}; allowed is a number")
    return float(number)


def _number(value: Any) -> Any:
    """What is not finite is written as null."""
    return float("nan") if value is None else value
