"""Landmarks: points with names."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Landmarks:
    """The landmarks of one specimen, as in its file."""

    points: NDArray[np.float64]
    """(k, 3) in the unit and the axes of the file, (k, 2) of flat ones; NaN where one is missing."""
    names: tuple[str, ...] = ()
    """One a landmark; none at all where the file names none."""
    space: str = ""
    """"RAS" or "LPS" where the file says which way its axes point; "" where it does not."""
    specimen: str = ""
    """What the file calls the specimen; "" where it does not."""
    image: str = ""
    """The picture that they were placed on, of TPS; "" where there is none."""

    def __repr__(self) -> str:
        space = f", {self.space}" if self.space else ""
        return f"Landmarks({len(self.points)} landmarks{space})"
