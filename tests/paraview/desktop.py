"""A screen of its own with ParaView's window on it, driven by keyboard and seen as pixels."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import numpy as np
import pytest

PROGRAMS = ("openbox", "xdotool", "import", "convert", "paraview")
SIZE = (1280, 860)

Found = TypeVar("Found")


@contextmanager
def screen(environment: dict[str, str]) -> Iterator[dict[str, str]]:
    """An X server on a display that nobody has; the environment to use it."""
    if shutil.which("Xvfb") is None:
        pytest.skip("Xvfb is not installed")
    read, write = os.pipe()
    server = subprocess.Popen(
        # It would start anew, refusing who comes meanwhile, whenever the last client leaves.
        ["Xvfb", "-noreset", "-displayfd", str(write), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24"],
        pass_fds=[write],
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    try:
        with os.fdopen(read) as display:
            number = display.readline().strip()
        yield environment | {"DISPLAY": f":{number}"}
    finally:
        server.terminate()
        server.wait()


class Desktop:
    """A window manager and ParaView on a screen; ends with the ``with`` block."""

    def __init__(self, environment: dict[str, str], *arguments: str) -> None:
        for program in PROGRAMS:
            if shutil.which(program) is None:
                pytest.skip(f"{program} is not installed")
        self._arguments = arguments
        self._environment = environment
        self._processes: list[subprocess.Popen] = []

    def __enter__(self) -> Desktop:
        self._start("openbox")
        self._start("paraview", "--disable-registry", *self._arguments)
        window = self._wait_for_window("ParaView 5|ParaView 6")
        self._do("xdotool", "windowmove", window, "0", "0")
        self._do("xdotool", "windowsize", window, str(SIZE[0]), str(SIZE[1] - 20))
        self._do("xdotool", "windowactivate", "--sync", window)
        self.settle()
        return self

    def __exit__(self, *_: object) -> None:
        for process in reversed(self._processes):
            process.kill()
            process.wait()

    def key(self, *keys: str) -> None:
        """Presses keys one after the other, each when the answer to the last one is drawn."""
        for name in keys:
            before = self.pixels()
            self._do("xdotool", "key", name)
            self.wait_until(lambda now, before=before: not np.array_equal(now, before))
            self.settle(rest=0.5)

    def click(self, x: int, y: int) -> None:
        self._do("xdotool", "mousemove", str(x), str(y), "click", "1")

    def drag(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        middle = ((start[0] + end[0]) // 2, (start[1] + end[1]) // 2)
        for place, *words in (
            (start, "mousedown", "1"),
            (middle,),
            (end,),
            (end, "sleep", "0.5", "mouseup", "1"),
        ):
            x, y = map(str, place)
            self._do("xdotool", "mousemove", x, y, "sleep", "0.3", *words)

    def wait_until(self, shown: Callable[[np.ndarray], bool], patience: float = 60) -> np.ndarray:
        """Waits until `shown` says so of the whole screen's picture; that picture."""

        def picture() -> np.ndarray | None:
            now = self.pixels()
            return now if shown(now) else None

        return _wait_for(picture, "what should be on the screen", patience)

    def settle(self, rest: float = 2, patience: float = 60) -> np.ndarray:
        """Waits until the picture stays the same for `rest` seconds; that picture."""
        deadline = time.monotonic() + patience
        before, since = self.pixels(), time.monotonic()
        while time.monotonic() < deadline:
            time.sleep(0.2)
            now = self.pixels()
            if not np.array_equal(now, before):
                before, since = now, time.monotonic()
            elif time.monotonic() - since > rest:
                return now
        raise AssertionError("the screen does not come to rest")

    def pixels(self) -> np.ndarray:
        """(height, width, 3) of the whole screen."""
        done = self._do("import", "-silent", "-window", "root", "-depth", "8", "rgb:-")
        return np.frombuffer(done.stdout, np.uint8).reshape(SIZE[1], SIZE[0], 3).astype(int)

    def save(self, path: Path) -> None:
        """The whole screen as a picture file."""
        self._do("import", "-window", "root", str(path))

    def _start(self, *command: str) -> None:
        self._processes.append(
            subprocess.Popen(
                command,
                env=self._environment,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        )

    def _do(self, *command: str) -> subprocess.CompletedProcess:
        return subprocess.run(command, env=self._environment, capture_output=True, check=True)

    def _wait_for_window(self, name: str, patience: float = 60) -> str:
        def window() -> str | None:
            found = subprocess.run(
                ["xdotool", "search", "--onlyvisible", "--name", name],
                env=self._environment,
                capture_output=True,
                text=True,
                check=False,
            )
            return found.stdout.split()[-1] if found.stdout.strip() else None

        return _wait_for(window, f"window {name}", patience)


def _wait_for(look: Callable[[], Found | None], name: str, patience: float) -> Found:
    """What `look` gives as soon as that is not None."""
    deadline = time.monotonic() + patience
    while time.monotonic() < deadline:
        found = look()
        if found is not None:
            return found
        time.sleep(0.2)
    raise AssertionError(f"no {name} within {patience:g} s")
