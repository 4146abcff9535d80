"""``mesh.symmetry`` on PyVista's data sets (PyVista 0.48 and later).

PyVista finds it by itself where symsurf is installed.

>>> mesh = pyvista.read("scan.ply")
>>> mesh.symmetry.detect(method="plane").mirror
>>> mesh.symmetry.plot()
>>> mesh.symmetry.asymmetry().plot(scalars="signed", cmap="coolwarm")
>>> mesh.symmetry.symmetries().field_data["group"]
"""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable
from hashlib import blake2b
from typing import Any

import numpy as np
import pyvista

from . import mirror_operations, shape_analyses
from ._core import InvalidInput
from .base.descriptions import name_function, renamed
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

    def __repr__(self) -> str:
        about = f"Symmetry of {type(self._mesh).__name__} ({self._mesh.n_points} points)"
        found = self._current()
        return f"{about}: {'detect() finds its mirror' if found is None else repr(found)}"

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

    def _analysed(self, name: str, options: dict[str, Any]) -> pyvista.DataSet:
        self._require_points(name)
        self.analysis = getattr(shape_analyses, name)(self._mesh, **options)
        return self.analysis.like(self._mesh)

    def _operated(self, name: str, options: dict[str, Any]) -> pyvista.DataSet:
        self._require_points(name)
        if not options.keys() & {"mirror", "result", "symmetry", "method", "seed"}:
            options = options | {"mirror": self._current()}
        made = renamed(result="mirror")(operate)(name, self._mesh, **options)
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


def _method(name: str, function: Callable[..., Any]) -> Callable[..., pyvista.DataSet]:
    """The function as a method, with its signature but for the shape."""

    def method(self: Symmetry, **options: Any) -> pyvista.DataSet:
        is_operation = name in mirror_operations.__all__
        return (self._operated if is_operation else self._analysed)(name, options)

    words = [
        word.replace(kind=word.KEYWORD_ONLY)
        for word in inspect.signature(function).parameters.values()
        if word.name not in ("shape", "values")
    ]
    own = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    summary, *_ = (function.__doc__ or "").split("\n\n")
    return name_function(
        method,
        name,
        __name__,
        inspect.Signature([own, *words], return_annotation="pyvista.DataSet"),
        [*summary.split("\n"), "", *_ABOUT.format(name=name).splitlines()],
    )


_ABOUT = """\
Gives a copy of the mesh with what ``symsurf.{name}`` gives: its points and faces, if they change, the
attributes that these take from the mesh, point arrays, and statistics in ``field_data``. Normals are
left out if points move. An operation uses ``mirror``, else the mirror last detected if points and cells
are still the same, else it finds one first; planes, axes and transformations of an analysis are then in
``analysis``. Options and errors are those of the function."""

for _module in (mirror_operations, shape_analyses):
    for _name in _module.__all__:
        setattr(Symmetry, _name, _method(_name, getattr(_module, _name)))


def _digest(mesh: pyvista.DataSet) -> bytes:
    """Of the points and cells; of a grid, whose points are many and stay, nothing."""
    digest = blake2b()
    if not is_grid(mesh):
        cells = [getattr(mesh, name, ()) for name in ("faces", "strips", "cells")]
        for values in (mesh.points, *cells):
            digest.update(np.ascontiguousarray(values).tobytes())
    return digest.digest()
