"""Results as JSON: every field by its name, the mirror as its kind and numbers."""

from __future__ import annotations

from typing import Any

from ..base.plain import plain
from ..results.base_result import BaseResult


def json_bytes(result: BaseResult) -> bytes:
    return record_bytes(plain(result.to_json()) | result.json_arrays())


def record_bytes(fields: dict[str, Any]) -> bytes:
    import json  # `import symsurf` does not wait for it

    return (json.dumps(fields, indent=1, allow_nan=False) + "\n").encode()
