"""Results and mirrors from JSON."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InvalidInput, InvalidParameter, Mirror, make_mirror
from ..result import Result


def load(path: str | os.PathLike[str]) -> Result[Mirror]:
    """See ``Result.load``."""
    path = Path(path)
    if path.suffix.lower() != ".json":
        raise InvalidParameter(f"path is {str(path)!r}; allowed is the suffix .json")
    try:
        record = json.loads(path.read_text())
    except OSError as error:
        raise InvalidInput(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise InvalidInput(f"{path}: no JSON ({error})") from error
    try:
        return _result(record)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise InvalidInput(f"{path}: no result that was saved ({error!r})") from error


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
        method=record["method"],
        mirror=None if mirror is None else mirror_from(mirror, footprint),
        surface_points=_rows(record.get("surface_points", []), 3, np.float64),
        pairs=_rows(record.get("pairs", []), 2, np.int64),
        residuals=np.array(record.get("residuals", []), dtype=np.float64),
        score=_number(record["score"]),
        candidates=candidates or [],
        parameters=_values(record.get("parameters", {})),
        statistics=_values(record.get("statistics", {})),
        seconds=record.get("seconds", 0.0),
    )


def _rows(values: Any, columns: int, kind: type) -> Any:
    return np.array(values, dtype=kind).reshape(-1, columns)


def _values(record: dict[str, Any]) -> dict[str, Any]:
    return {name: _value(value) for name, value in record.items()}


def _value(value: Any) -> Any:
    return np.array(value, dtype=np.float64) if isinstance(value, list) else _number(value)


def _number(value: Any) -> Any:
    """What is not finite is written as null."""
    return float("nan") if value is None else value
