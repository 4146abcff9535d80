"""``mesh.symmetry`` on PyVista's data sets (PyVista 0.48 and later).

PyVista finds it by itself where symsurf is installed.

>>> mesh = pyvista.read("scan.ply")
>>> mesh.symmetry.detect(method="plane").mirror
>>> mesh.symmetry.plot()
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import pyvista

from .detection import detect
from .result import Result
from .shape import Shape

__all__ = ["Symmetry"]


@pyvista.register_dataset_accessor("symmetry", pyvista.DataSet)
class Symmetry:
    """The mirror of a data set's points."""

    def __init__(self, mesh: pyvista.DataSet) -> None:
        self._mesh = mesh
        self.result: Result | None = None
        """What the last ``detect`` found."""

    def detect(self, method: str = "auto", **options: Any) -> Result:
        """Finds the mirror; options, result and errors are those of ``symsurf.detect``."""
        self.result = detect(self._mesh.points, method, **options)
        return self.result

    def plot(self, path: str | os.PathLike[str] | None = None) -> pyvista.Plotter:
        """Draws the mesh with the mirror last detected, or detects it first.

        path: a PNG to write off-screen; without it a window opens.
        """
        result = self.result or self.detect()
        return result.plot(path, shape=Shape(np.asarray(self._mesh.points), self._triangles()))

    def _triangles(self) -> np.ndarray | None:
        if not isinstance(self._mesh, pyvista.PolyData) or self._mesh.GetNumberOfPolys() == 0:
            return None
        return self._mesh.triangulate().regular_faces.astype(np.int64)
