"""The extension in Blender's own window, where there is one: no registry of Python has it.

SYMSURF_BLENDER names the program, in which the extension is installed and switched on; it is started on
a screen of its own.
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

INSIDE = Path(__file__).parent / "inside"


@pytest.fixture(scope="module")
def seen(tmp_path_factory) -> dict[str, object]:
    program = os.environ.get("SYMSURF_BLENDER")
    if not program:
        pytest.skip("SYMSURF_BLENDER names no Blender with a window; see docs/blender.md")
    words = [program, "--enable-event-simulate", "--window-geometry", "0", "0", "1280", "800"]
    script = ["--python", INSIDE / "window.py", "--", tmp_path_factory.mktemp("pictures")]
    done = subprocess.run(
        ["xvfb-run", "--auto-servernum", "--server-args=-screen 0 1280x800x24", *words, *script],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def test_escape_cancels_and_leaves_everything(seen):
    assert seen["invoked"] == ["RUNNING_MODAL"]
    assert seen["cancelled_after"] < 2
    assert seen["same_after_esc"] and not seen["mirror_after_esc"]


def test_operator_finishes_beside_the_window(seen):
    assert seen["moved"] and seen["last_operator"] == "SYMSURF_OT_symmetrize"


def test_undo_takes_a_step_for_each(seen):
    assert seen["same_after_undo"]
