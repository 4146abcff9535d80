"""``mesh.symmetry`` on PyVista's data sets (PyVista 0.48 and later).

PyVista finds it by itself where symsurf is installed.

>>> mesh = pyvista.read("scan.ply")
>>> mesh.symmetry.detect(method="plane").mirror
>>> mesh.symmetry.plot()
>>> mesh.symmetry.asymmetry().plot(scalars="signed", cmap="coolwarm")
>>> mesh.symmetry.symmetries().field_data["group"]
"""

from __future__ import annotations

import os
from hashlib import blake2b
from typing import Any

import numpy as np
import pyvista

from . import shape_analyses
from ._core import InvalidInput
from .detection import detect
from .mirror_operations.operate import operate
from .results import AnalysisResult, Result
from .shapes.grids import is_grid

__all__ = ["Symmetry"]


@pyvista.register_dataset_accessor("symmetry", pyvista.DataSet)
class Symmetry:
    """The symmetry of a data set: of a mesh's surface, a cloud's points, or the mirror of a mask."""

    def __init__(self, mesh: pyvista.DataSet) -> None:
        self._mesh = mesh
        self._result: Result | None = None
        self._found_for = b""  # a digest of the points and cells
        self.analysis: AnalysisResult | None = None
        """What the last analysis found, such as ``symmetries``: planes, axes, transformations."""

    @property
    def result(self) -> Result | None:
        """What the last ``detect`` found, or an operation that found its mirror first."""
        return self._result

    @result.setter
    def result(self, result: Result | None) -> None:
        self._result, self._found_for = result, _digest(self._mesh)

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
        result = self._current()
        if options or result is None:
            result = self.detect(**options)
        return result.plot(path)

    def asymmetry(self, **options: Any) -> pyvista.DataSet:
        """A copy of the mesh with the point arrays of ``symsurf.asymmetry``, and its statistics in
        ``field_data``. Over ``result``, or the mirror last detected if points and cells are still
        the same, or the one that is found first; options and errors are those of the function. The
        other operations likewise; where they move points, the copy has no normals."""
        return self._operated("asymmetry", options)

    def correspondences(self, **options: Any) -> pyvista.DataSet:
        """A copy with the point arrays of ``symsurf.correspondences``."""
        return self._operated("correspondences", options)

    def align(self, **options: Any) -> pyvista.DataSet:
        """A copy turned by ``symsurf.align``; ``field_data["matrix"]`` has the turn."""
        return self._operated("align", options)

    def complete(self, **options: Any) -> pyvista.PolyData:
        """The surface of triangles, or the points, with what ``symsurf.complete`` adds: the point
        array "origin" says which is which. What is added has the attributes that its counterpart
        has."""
        return self._operated("complete", options)

    def symmetrize(self, **options: Any) -> pyvista.DataSet:
        """A copy made symmetric by ``symsurf.symmetrize``; with ``triangles="mirrored"`` a surface of
        triangles, or points, with the attributes that lie between those of the mesh."""
        return self._operated("symmetrize", options)

    def straighten(self, **options: Any) -> pyvista.DataSet:
        """A copy whose mirror ``symsurf.straighten`` has laid flat."""
        return self._operated("straighten", options)

    def remesh(self, **options: Any) -> pyvista.PolyData:
        """The surface with the even, exactly symmetric triangles of ``symsurf.remesh``, with the
        attributes that lie between those of the mesh."""
        return self._operated("remesh", options)

    def cut(self, **options: Any) -> pyvista.PolyData:
        """One side of the mirror, by ``symsurf.cut``, with the attributes that lie between those of
        the mesh; the cell array "cap" says which faces close it."""
        return self._operated("cut", options)

    def transfer(self, **options: Any) -> pyvista.DataSet:
        """A copy whose point arrays ``symsurf.transfer`` has carried to the other side, but for
        normals and texture coordinates; the point array "failed" says where that was not possible."""
        return self._operated("transfer", options)

    def illuminate(self, **options: Any) -> pyvista.DataSet:
        """A copy with the point arrays of ``symsurf.illuminate``: how many paths lead from the light
        over the mirror to each point, and how bright it is."""
        return self._operated("illuminate", options)

    def symmetries(self, **options: Any) -> pyvista.DataSet:
        """A copy of the mesh with the group of ``symsurf.symmetries`` and its other statistics in
        ``field_data``; planes, axes and elements are then in ``analysis``. Options and errors are
        those of the function. The other analyses likewise, with point arrays where they give any."""
        return self._analysed("symmetries", options)

    def partial_symmetries(self, **options: Any) -> pyvista.DataSet:
        """A copy with the point arrays of ``symsurf.partial_symmetries``: the transformation that
        maps a point's patch, and the side."""
        return self._analysed("partial_symmetries", options)

    def recurring_parts(self, **options: Any) -> pyvista.DataSet:
        """A copy with the point arrays of ``symsurf.recurring_parts``: the part, and its instance."""
        return self._analysed("recurring_parts", options)

    def symmetry_embedding(self, **options: Any) -> pyvista.DataSet:
        """A copy with the point arrays of ``symsurf.symmetry_embedding``: orbits, coordinates and the
        distance from what stays in its place."""
        return self._analysed("symmetry_embedding", options)

    def intrinsic_symmetry(self, **options: Any) -> pyvista.DataSet:
        """A copy with the point arrays of ``symsurf.intrinsic_symmetry``: the point on the other side,
        and the confidence."""
        return self._analysed("intrinsic_symmetry", options)

    def _analysed(self, name: str, options: dict[str, Any]) -> pyvista.DataSet:
        self._require_points(name)
        self.analysis = getattr(shape_analyses, name)(self._mesh, **options)
        return self.analysis.like(self._mesh)

    def _operated(self, name: str, options: dict[str, Any]) -> pyvista.DataSet:
        self._require_points(name)
        if not options.keys() & {"result", "symmetry", "method", "seed"}:
            options = options | {"result": self._current()}
        made = operate(name, self._mesh, **options)
        if made.found is not None:
            self.result = made.found
        return made.like(self._mesh)

    def _current(self) -> Result | None:
        """What was found of the mesh as it is now."""
        is_same = self._result is not None and self._found_for == _digest(self._mesh)
        return self._result if is_same else None

    def _require_points(self, name: str) -> None:
        if is_grid(self._mesh):
            raise InvalidInput(
                f"{name} takes the points of a surface or a cloud; {type(self._mesh).__name__} has "
                "none: give a surface of it, such as contour()"
            )


def _digest(mesh: pyvista.DataSet) -> bytes:
    """Of the points and cells; of a grid, whose points are many and stay, nothing."""
    digest = blake2b()
    if not is_grid(mesh):
        cells = [getattr(mesh, name, ()) for name in ("faces", "strips", "cells")]
        for values in (mesh.points, *cells):
            digest.update(np.ascontiguousarray(values).tobytes())
    return digest.digest()
