"""How results are saved and drawn: the layers above register a function for each of their classes."""

from __future__ import annotations

import os
from functools import singledispatch
from typing import Any


@singledispatch
def save(result: object, path: str | os.PathLike[str]) -> list[str]:
    """Writes a result; ``symsurf.saving`` registers how. Gives what the file does not hold, a sentence
    each."""
    raise NotImplementedError(type(result).__name__)


@singledispatch
def plot(result: object, path: str | os.PathLike[str] | None = None, **options: Any) -> Any:
    """Draws a result; ``symsurf.plotting`` registers how."""
    raise NotImplementedError(type(result).__name__)
