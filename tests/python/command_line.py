"""The command line: as users run it, and without a process of its own where there are many lines."""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
from pathlib import Path

from symsurf.cli import main

Done = subprocess.CompletedProcess


def run(*words: object, cwd: Path | None = None, errors: str = "strict") -> Done[str]:
    command = [sys.executable, "-m", "symsurf", *map(str, words)]
    return subprocess.run(
        command, cwd=cwd, capture_output=True, text=True, errors=errors, timeout=120, check=False
    )


def run_here(line: str, folder: Path) -> Done[str]:
    words, before = line.split(), os.getcwd()
    output, errors = io.StringIO(), io.StringIO()
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            status = main(words)
    except SystemExit as stop:
        status = stop.code
    finally:
        os.chdir(before)
    return Done(words, status, output.getvalue(), errors.getvalue())
