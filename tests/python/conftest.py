from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)


@pytest.fixture
def blob(rng: np.random.Generator) -> np.ndarray:
    """Points without any symmetry in particular."""
    return rng.normal(size=(500, 3)) * (1, 2, 3)


@pytest.fixture
def shapes() -> Path:
    """The folder of sample shapes, which is not part of the repository."""
    folder = Path(os.environ.get("SYMSURF_SHAPES", ROOT.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no sample shapes in {folder}; SYMSURF_SHAPES names another folder")
    return folder
