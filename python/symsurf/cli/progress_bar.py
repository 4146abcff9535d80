"""A bar on the terminal."""

from __future__ import annotations

import sys
from types import TracebackType

WIDTH = 30


class ProgressBar:
    """Shows the fraction done on standard error, where that is a terminal; gone when it is left."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._shown = sys.stderr.isatty()

    def __call__(self, fraction: float) -> None:
        if self._shown:
            done = round(WIDTH * fraction)
            bar = _mark(sys.stderr.encoding) * done + " " * (WIDTH - done)
            print(
                f"\r{self._title} {bar} {fraction:4.0%}", end="\033[K", file=sys.stderr, flush=True
            )

    def clear(self) -> None:
        if self._shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)

    def __enter__(self) -> ProgressBar:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.clear()


def _mark(encoding: str) -> str:
    try:
        "━".encode(encoding)
    except UnicodeEncodeError:
        return "#"
    return "━"
