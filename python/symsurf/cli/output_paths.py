"""What is asked of a file to write before the work is done."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from .._core import InvalidParameter


def require_suffix(name: str, path: Path, suffix: str) -> None:
    if path.suffix.lower() != suffix:
        raise InvalidParameter(f"{name} is {str(path)!r}; allowed is the suffix {suffix}")


def require_apart(path: Path, taken: Collection[Path]) -> None:
    """From the resolved inputs and other outputs."""
    if path.resolve() in taken:
        raise InvalidParameter(f"{path} is an input or another output; allowed is another name")
