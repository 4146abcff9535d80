"""A bar on the terminal."""

from __future__ import annotations

import shutil
import sys
import time
from types import TracebackType

WIDTH = 30
# s before the first time is shown
_FIRST_TIME = 2.0


class ProgressBar:
    """Shows the fraction done on standard error, if that is a terminal, with the time left or elapsed;
    gone when it is left."""

    def __init__(self, title: str) -> None:
        self.title = title
        self._shown = sys.stderr.isatty()
        self._started = time.monotonic()

    def __call__(self, fraction: float, even: bool = False) -> None:
        """Draws the bar.

        Args:
            even: the fraction is that of files done, which tells the time left. Otherwise it is that of
                steps, of which the last may take as long as all before it.
        """
        if self._shown:
            done = round(WIDTH * fraction)
            bar = _mark(sys.stderr.encoding) * done + " " * (WIDTH - done)
            elapsed = time.monotonic() - self._started
            state = f" {bar} {fraction:4.0%}{time_shown(elapsed, fraction if even else None)}"
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


def time_shown(elapsed: float, fraction: float | None) -> str:
    """The time left if the rest takes as long per file as what is done, otherwise the time elapsed.

    Args:
        elapsed: s since the start.
        fraction: of the files done by now, in [0, 1]; None if that is unknown.
    """
    if elapsed < _FIRST_TIME or fraction == 1:
        return ""
    if not fraction:
        return f", {_in_words(elapsed)}"
    return f", {_in_words(elapsed * (1 - fraction) / fraction)} left"


def _in_words(seconds: float) -> str:
    minutes = round(seconds / 60)
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 100 else f"{round(minutes / 60)} h"


def _mark(encoding: str) -> str:
    try:
        "━".encode(encoding)
    except UnicodeEncodeError:
        return "#"
    return "━"
