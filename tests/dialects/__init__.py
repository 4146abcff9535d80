"""One shape as the definitions of formats and the programs that are used most write it: for each format
the content of files by a name of the dialect."""

from __future__ import annotations

import numpy as np

# Whole numbers of quarters, which single precision, ten decimals and LAS's scale all hold.
POINTS = np.array(
    [(0, 0, 0), (4, 0, 0.25), (4, 3, 0), (-0.5, 3, 0), (2, 1.25, -2.5), (1.75, 1, 5)], dtype=float
)
QUAD = (0, 3, 2, 1)
FACES = np.array([(0, 3, 2), (0, 2, 1), (0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 0, 5), (0, 4, 1)])
NORMALS = np.array([(0.0, 0.6, 0.8)] * 6)
