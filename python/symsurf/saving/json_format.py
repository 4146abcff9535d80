"""Results as JSON: every field by its name, the mirror as its kind and numbers."""

from __future__ import annotations

from typing import Any

from .._core import Mirror
from ..base.plain import plain
from ..results import AnalysisResult, OperationResult, Result


def json_bytes(result: Result) -> bytes:
    return record_bytes(record(result))


def record_bytes(fields: dict[str, Any]) -> bytes:
    import json  # `import symsurf` does not wait for it

    return (json.dumps(fields, indent=1, allow_nan=False) + "\n").encode()


def record(result: Result) -> dict[str, Any]:
    """The whole result in what JSON knows: lists for arrays, null for NaN and infinity."""
    return summary(result) | {
        "pairs": plain(result.pairs),
        "residuals": plain(result.residuals),
        "surface_points": plain(result.surface_points),
        "space": result.space,
        "footprint": None if result.mirror is None else plain(result.mirror.footprint),
    }


def operation_bytes(result: OperationResult) -> bytes:
    whole = {
        "operation": result.operation,
        "mirror": mirror_record(result.mirror),
        "parameters": plain(result.parameters),
        "statistics": plain(result.statistics),
        "space": result.shape.space,
        "arrays": plain(result.arrays),
    }
    return record_bytes(whole)


def analysis_bytes(result: AnalysisResult) -> bytes:
    own = {"space": result.shape.space, "arrays": plain(result.arrays)}
    return record_bytes(plain(result.to_json()) | own)


def summary(result: Result) -> dict[str, Any]:
    """What a result says without its points: a few lines, however large the input."""
    return {
        "method": result.method,
        "mirror": mirror_record(result.mirror),
        "score": plain(result.score),
        "seconds": result.seconds,
        "parameters": plain(result.parameters),
        "statistics": plain(result.statistics),
        "candidates": [
            {
                "method": candidate.method,
                "mirror": mirror_record(candidate.mirror),
                "score": plain(candidate.score),
            }
            for candidate in result.candidates
        ],
    }


def mirror_record(mirror: Mirror | None) -> dict[str, Any] | None:
    return None if mirror is None else {"kind": mirror.kind} | plain(mirror.numbers)
