"""VTK's data sets, by VTK's own readers: VTP, VTU, VTI and the legacy VTK."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pyvista
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOLegacy import vtkDataSetReader
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader,
    vtkXMLPolyDataReader,
    vtkXMLUnstructuredGridReader,
)

from .._core import InvalidInput, InvalidParameter
from ..grids import is_grid, points_above
from ..shape import Shape

_READERS: dict[str, Any] = {
    ".vtp": vtkXMLPolyDataReader,
    ".vtu": vtkXMLUnstructuredGridReader,
    ".vti": vtkXMLImageDataReader,
    ".vtk": vtkDataSetReader,
}
# VTK calls some broken files no error, but warns of them.
_COMPLAINT = re.compile(
    r"^(?:ERROR: .*\n(?:.*?\): )?(.*)|.*\n(?:.*?\): )?(.*Error .*))", re.MULTILINE
)


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    """Points, flat cells as triangles and point normals; of a regular grid what the threshold
    chooses of it."""
    reader = _READERS[path.suffix.lower()]()
    reader.SetFileName(str(path))
    if isinstance(reader, vtkDataSetReader):
        reader.ReadAllScalarsOn()
        reader.ReadAllNormalsOn()
    with _complaints_raised():
        reader.Update()
    output = reader.GetOutputDataObject(0)
    if output is None:
        raise InvalidInput("VTK finds no data set in it")
    data = pyvista.wrap(output)
    if is_grid(data):
        return Shape(points_above(data, threshold, scalars))
    for name, value in (("threshold", threshold), ("scalars", scalars)):
        if value is not None:
            raise InvalidParameter(f"{name} is {value!r}; allowed is None, as this is no image")
    return Shape.from_pyvista(data)


@contextmanager
def _complaints_raised() -> Iterator[None]:
    """What VTK would print of a file is raised as InvalidInput."""
    before, window = vtkOutputWindow.GetInstance(), vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_INFO)  # VTK's default
        vtkOutputWindow.SetInstance(before)
    if found := _COMPLAINT.search(window.GetOutput()):
        raise InvalidInput(f"VTK cannot read it: {found[1] or found[2]}")
