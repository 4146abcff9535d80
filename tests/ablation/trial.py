"""One trial: in a module of its own, which processes that start afresh can import."""

from __future__ import annotations

from collections.abc import Mapping

Figures = Mapping[str, float]
Task = tuple[str, str, int]
"""The name of a case, the shape and the seed."""


def trial(task: Task) -> Figures:
    from accuracy.__main__ import CASES

    name, subject, seed = task
    return CASES[name].trial(subject, seed)
