"""``mesh.symmetry`` on PyVista's data sets (PyVista 0.48 and later).

PyVista finds it by itself where symsurf is installed.

>>> mesh = pyvista.read("scan.ply")
>>> mesh.symmetry.detect(method="plane").mirror
>>> mesh.symmetry.plot()
>>> mesh.symmetry.asymmetry().plot(scalars="signed", cmap="coolwarm")
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import pyvista

from . import mirror_operations
from ._core import InvalidInput
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

    def asymmetry(self, **options: Any) -> pyvista.DataSet:
        """A copy of the mesh with the point arrays of ``symsurf.asymmetry``, and its statistics in
        ``field_data``. Over the mirror last detected, or the one that is found first; options and
        errors are those of the function. The other operations likewise."""
        return self._operated("asymmetry", options)

    def correspondences(self, **options: Any) -> pyvista.DataSet:
        """A copy with the point arrays of ``symsurf.correspondences``."""
        return self._operated("correspondences", options)

    def align(self, **options: Any) -> pyvista.DataSet:
        """A copy turned by ``symsurf.align``; ``field_data["matrix"]`` has the turn."""
        return self._operated("align", options)

    def symmetrize(self, **options: Any) -> pyvista.DataSet:
        """A copy made symmetric by ``symsurf.symmetrize``."""
        return self._operated("symmetrize", options)

    def straighten(self, **options: Any) -> pyvista.DataSet:
        """A copy whose mirror ``symsurf.straighten`` has laid flat."""
        return self._operated("straighten", options)

    def _operated(self, name: str, options: dict[str, Any]) -> pyvista.DataSet:
        if isinstance(self._mesh, (pyvista.ImageData, pyvista.RectilinearGrid)):
            raise InvalidInput(
                f"{name} takes points that it may move; {type(self._mesh).__name__} has none: give a "
                "surface of it, such as contour()"
            )
        result = getattr(mirror_operations, name)(self._mesh, self.result, **options)
        made = self._mesh.copy()
        made.points = result.shape.points
        for array, values in result.arrays.items():
            made.point_data[array] = values
        for figure, value in result.statistics.items():
            made.field_data[figure] = np.atleast_1d(value)
        return made
