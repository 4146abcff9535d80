"""``mesh.symmetry`` on PyVista's data sets (PyVista 0.48 and later).

PyVista finds it by itself where symsurf is installed.

>>> mesh = pyvista.read("scan.ply")
>>> mesh.symmetry.detect(method="plane").mirror
>>> mesh.symmetry.plot()
"""

from __future__ import annotations

import os
from typing import Any

import pyvista

from .detection import detect
from .result import Result

__all__ = ["Symmetry"]


@pyvista.register_dataset_accessor("symmetry", pyvista.DataSet)
class Symmetry:
    """The mirror of a data set: of a mesh's surface, a cloud's points, or a mask."""

    def __init__(self, mesh: pyvista.DataSet) -> None:
        self._mesh = mesh
        self.result: Result | None = None
        """What the last ``detect`` found."""

    def detect(self, method: str = "auto", **options: Any) -> Result:
        """Finds the mirror; options, result and errors are those of ``symsurf.detect``.

        Of a mask or an image (``ImageData``, ``RectilinearGrid``) not the grid's own symmetry, but
        that of the points whose scalar is above ``threshold``; pairs are then indices into
        ``Result.points``, which are these.
        """
        self.result = detect(self._mesh, method, **options)
        return self.result

    def plot(self, path: str | os.PathLike[str] | None = None, **options: Any) -> pyvista.Plotter:
        """Draws the mesh with the mirror last detected, or detects it first, with these options.

        path: a PNG to write off-screen; without it a window opens.
        """
        result = self.detect(**options) if options or self.result is None else self.result
        return result.plot(path)
