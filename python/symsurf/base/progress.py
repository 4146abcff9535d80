"""Progress of work in parts."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[float], "bool | None"]


def share(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """What a part of the work calls with the fraction of it that is done."""
    if progress is None:
        return None
    return lambda fraction: progress(begin + (end - begin) * fraction)
