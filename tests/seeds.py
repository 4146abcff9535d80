"""How much the tests draw: little by default, SYMSURF_SEEDS=8 or more is the full run.

``tests/core/seeds.h`` is the same of the core's tests."""

from __future__ import annotations

import math
import os

import pytest

SEEDS = int(os.environ.get("SYMSURF_SEEDS", "2"))
"""Draws of a case: whatever fails for one of them fails."""
if SEEDS < 1:
    raise ValueError(f"SYMSURF_SEEDS is {SEEDS}; allowed is 1 or more")

each_seed = pytest.mark.parametrize("seed", range(SEEDS))

FULL = 8
full_run = pytest.mark.skipif(SEEDS < FULL, reason="only in the full run: make test-full")
"""Of what takes long for what it shows, and of faults that a few draws do not show."""


def draws(of_the_full_run: int) -> int:
    """How many draws there are where the full run makes so many."""
    return math.ceil(of_the_full_run * SEEDS / FULL)
