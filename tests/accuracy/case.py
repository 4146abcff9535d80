"""What is measured: cases, their bars, and the figures of one trial."""

from __future__ import annotations

import time
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import symsurf

Figures = Mapping[str, float]
"""By name; NaN where a trial has no such figure. A mirror that was not found has an error of inf."""


@dataclass(frozen=True)
class Bar:
    """What a figure must reach in the median: limits, both of them allowed."""

    low: float = -np.inf
    high: float = np.inf

    def met(self, value: float) -> bool:
        return self.low <= value <= self.high

    def __str__(self) -> str:
        if np.isfinite(self.low) and np.isfinite(self.high):
            return f"{self.low:.4g} to {self.high:.4g}"
        return f"<= {self.high:.4g}" if np.isfinite(self.high) else f">= {self.low:.4g}"


@dataclass(frozen=True)
class Case:
    """A family of shapes and a damage, and what is asked of the method there."""

    name: str
    subjects: tuple[str, ...]
    run: Callable[[str, np.random.Generator], Figures]
    """One trial on one of the subjects."""
    bars: Mapping[str, Bar] = field(default_factory=dict)
    trials: int = 20
    """Of each subject, for figures to rely on."""

    def trial(self, subject: str, seed: int) -> Figures:
        key = zlib.crc32(f"{self.name}/{subject}".encode())
        return self.run(subject, np.random.default_rng([seed, key]))


def at_most(limit: float) -> Bar:
    return Bar(high=limit)


def at_least(limit: float) -> Bar:
    return Bar(low=limit)


def within(low: float, high: float) -> Bar:
    return Bar(low, high)


def timed_detect(points: NDArray[np.float64], method: str) -> tuple[symsurf.Result, float]:
    """The result, and the seconds of one core that it took."""
    start = time.process_time()
    result = symsurf.detect(points, method=method, threads=1)
    return result, time.process_time() - start
