"""A bar on the terminal."""

from __future__ import annotations

import shutil
import sys
import time
from types import TracebackType

WIDTH = 30
# s before the first guess of what is left, which would be far off
_FIRST_GUESS = 2.0


class ProgressBar:
    """Shows the fraction done and the time left on standard error, where that is a terminal; gone
    when it is left."""

    def __init__(self, title: str) -> None:
        self.title = title
        self._shown = sys.stderr.isatty()
        self._started = time.monotonic()

    def __call__(self, fraction: float) -> None:
        if self._shown:
            done = round(WIDTH * fraction)
            bar = _mark(sys.stderr.encoding) * done + " " * (WIDTH - done)
            left = time_left(time.monotonic() - self._started, fraction)
            state = f" {bar} {fraction:4.0%}{left}"
            title = self.title[: max(0, shutil.get_terminal_size().columns - 1 - len(state))]
            print(f"\r{title}{state}", end="\033[K", file=sys.stderr, flush=True)

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


def time_left(elapsed: float, fraction: float) -> str:
    """In words, where the rest takes as long as what is done did; nothing where that is a guess.

    Args:
        elapsed: s since the start.
        fraction: that is done by now, in [0, 1].
    """
    if elapsed < _FIRST_GUESS or not 0 < fraction < 1:
        return ""
    seconds = round(elapsed * (1 - fraction) / fraction)
    if seconds < 100:
        return f", {seconds} s left"
    minutes = round(seconds / 60)
    return f", {minutes} min left" if minutes < 100 else f", {round(minutes / 60)} h left"


def _mark(encoding: str) -> str:
    try:
        "━".encode(encoding)
    except UnicodeEncodeError:
        return "#"
    return "━"
