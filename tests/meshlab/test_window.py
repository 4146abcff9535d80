"""MeshLab's own window on a virtual screen: the menu, the dialog and the result.

Needs the MeshLab that `make test-full` and `make meshlab-gui` build. The pictures are left beside it, in
`pictures`, to be looked at.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from airplane import bent_airplane, write_obj
from conftest import BUILD, plugin_file
from PIL import Image
from seeds import full_run

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")

PROGRAM = BUILD.parent / "meshlab-gui" / "src" / "distrib" / "meshlab"
PATIENCE = 60

pytestmark = [
    full_run,
    pytest.mark.skipif(
        not PROGRAM.exists(), reason="MeshLab's window is not built: make meshlab-gui"
    ),
]


class Window:
    """MeshLab with one mesh open; clicks and pictures at places of a 1280 x 800 screen."""

    def __init__(self, folder: Path, mesh_file: Path):
        self.pictures = PROGRAM.parents[2] / "pictures"
        self.pictures.mkdir(exist_ok=True)
        self.mesh_file = mesh_file
        self.log = folder / "log"
        self.environment = os.environ | {
            "HOME": str(folder),
            "XDG_RUNTIME_DIR": str(folder),
            "LIBGL_ALWAYS_SOFTWARE": "1",
        }
        self.processes = [self._start_screen()]
        self.processes.append(self._start("openbox"))
        self.processes.append(self._start(PROGRAM, mesh_file, log=self.log))
        self._wait(lambda: self.has("Send Anonymous Statistics"))
        self.press("n")
        self._wait(lambda: "All files opened" in self.log.read_text())

    def close(self) -> None:
        for process in reversed(self.processes):
            process.send_signal(signal.SIGTERM)
            process.wait(PATIENCE)

    def alive(self) -> bool:
        return self.processes[-1].poll() is None

    def has(self, title: str) -> bool:
        return self._xdotool("search", "--onlyvisible", "--name", title).returncode == 0

    def button(self, title: str, column: int) -> tuple[int, int]:
        """Where the button of the lowest row of two is in the dialog of that title."""
        found = self._xdotool("search", "--onlyvisible", "--name", title)
        shown = self._xdotool("getwindowgeometry", "--shell", found.stdout.split()[-1].decode())
        place = dict(line.split("=") for line in shown.stdout.decode().split())
        left, top, width, height = (int(place[key]) for key in ("X", "Y", "WIDTH", "HEIGHT"))
        return left + (2 * column + 1) * width // 4, top + height - 22

    def click(self, x: int, y: int) -> None:
        """Clicks there, and waits until that is answered on the screen."""
        self._xdotool("mousemove", x, y)
        before = self.seen()
        self._xdotool("click", 1)
        self._wait(lambda: not np.array_equal(self.seen(), before))

    def press(self, *keys: str) -> None:
        self._xdotool("key", "--delay", 300, *keys)

    def wait_for_log(self, text: str) -> str:
        self._wait(lambda: text in self.log.read_text())
        time.sleep(2)
        return self.log.read_text()

    def seen(self) -> np.ndarray:
        """The screen, (rows, columns, 3)."""
        command = ["import", "-silent", "-window", "root", "-depth", "8", "rgb:-"]
        done = subprocess.run(command, env=self.environment, capture_output=True, check=True)
        return np.frombuffer(done.stdout, np.uint8).reshape(800, 1280, 3).astype(int)

    def picture(self, name: str) -> np.ndarray:
        """The screen, also left in the folder of pictures."""
        seen = self.seen()
        Image.fromarray(seen.astype(np.uint8)).save(self.pictures / f"{name}.png")
        return seen

    def _start_screen(self) -> subprocess.Popen:
        """An X server on a display that nobody has."""
        read, write = os.pipe()
        server = self._start(
            *("Xvfb", "-noreset", "-displayfd", write, "-screen", "0", "1280x800x24"),
            pass_fds=[write],
        )
        os.close(write)
        with os.fdopen(read) as display:
            self.environment["DISPLAY"] = f":{display.readline().strip()}"
        return server

    def _start(
        self, *command: object, log: Path | None = None, pass_fds: Sequence[int] = ()
    ) -> subprocess.Popen:
        sink = subprocess.DEVNULL if log is None else log.open("w")
        words = [str(word) for word in command]
        return subprocess.Popen(
            words, env=self.environment, stdout=sink, stderr=sink, pass_fds=pass_fds
        )

    def _xdotool(self, *words: object) -> subprocess.CompletedProcess:
        command = ["xdotool", *map(str, words)]
        return subprocess.run(command, env=self.environment, capture_output=True, check=False)

    def _wait(self, condition) -> None:
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end, f"no answer for {PATIENCE} s"
            time.sleep(0.5)
        time.sleep(1)


@pytest.fixture
def window(tmp_path):
    loaded = PROGRAM.parent / "plugins" / "filter_symsurf.so"
    loaded.unlink(missing_ok=True)
    shutil.copy(plugin_file("float"), loaded)
    opened = Window(tmp_path, write_obj(tmp_path / "airplane.obj", *bent_airplane()))
    yield opened
    opened.close()


def pixels(picture: np.ndarray, strong: int) -> int:
    """How many in the 3D view have one colour and next to nothing of the others. MeshLab's ramp
    runs from blue (2), no residual, over green (1) to red, the largest."""
    view = picture[95:660, 5:800]
    others = np.delete(view, strong, axis=-1)
    return int(np.sum((view[..., strong] > 100) & (others < 40).all(axis=-1)))


def place_in_submenu(title: str) -> tuple[int, int]:
    """Where the entry stands: by the alphabet, among those of the plugin for selecting."""
    others = ["Select by Face Quality", "Select by Vertex Quality"]
    measuring = [
        o.title for o in symsurf.operations().values() if not (o.moves_points or o.adds_points)
    ]
    titles = [method.title for method in symsurf.methods().values()] + measuring + others
    return 580, 281 + 25 * sorted(titles, key=str.lower).index(title)


def test_menu_dialog_and_result(window):
    filters, quality = (120, 30), (240, 280)
    window.click(*filters)
    window.click(*quality)
    before = window.picture("menu")
    window.click(*place_in_submenu("Mirror plane"))
    assert window.has("Mirror plane")
    window.picture("dialog")
    close, apply = (window.button("Mirror plane", column) for column in (0, 1))
    window.click(*apply)
    log = window.wait_for_log("Applied filter: Mirror plane")
    window.click(*close)
    after = window.picture("result")
    assert window.alive()
    airplane = symsurf.read(window.mesh_file)
    as_read = airplane.points.astype(np.float32)  # this MeshLab's coordinates are floats
    expected = symsurf.detect(as_read, "plane", faces=airplane.faces).score
    score = float(re.search(r"Mirror plane: score: (\S+)", log)[1])
    assert score == pytest.approx(expected, abs=1e-4)
    # The body is as good as exact, the wings are not.
    assert pixels(before, 2) == pixels(before, 1) == 0
    assert pixels(after, 2) > 5000 and pixels(after, 1) > 500
