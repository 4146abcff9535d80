"""Calls with drawn clouds, meshes and parameters, as many of them as the test has time for."""

from __future__ import annotations

import subprocess
import sys

from conftest import ROOT
from seeds import draws


def test_drawn_calls_have_no_findings():
    words = ["--count", str(draws(288)), "--points", "60"]
    done = subprocess.run(
        [sys.executable, str(ROOT / "tests" / "fuzz" / "python"), *words],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
