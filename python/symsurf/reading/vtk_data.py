"""VTK's data sets, by VTK's own readers: VTP, VTU, VTI and the legacy VTK."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
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
from ..base.options import Reading
from ..shapes import Shape
from ..shapes.grids import chosen_points, is_grid
from ..shapes.space import space_in

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


def read(path: Path, reading: Reading) -> Shape:
    """Points, flat cells as triangles and point normals; of a regular grid what is chosen of it."""
    reader = _READERS[path.suffix.lower()]()
    reader.SetFileName(str(path))
    if isinstance(reader, vtkDataSetReader):
        reader.ReadAllScalarsOn()
        reader.ReadAllNormalsOn()
    with complaints_raised():
        reader.Update()
    output = reader.GetOutputDataObject(0)
    if output is None:
        raise InvalidInput("VTK finds no data set in it")
    data = pyvista.wrap(output)
    if is_grid(data):
        return Shape(chosen_points(data, reading))
    for name, value in reading.of_image().items():
        raise InvalidParameter(f"{name} is {value!r}; allowed is None, as this is no image")
    return replace(Shape.from_pyvista(data), space=_space(data, reader))


def _space(data: Any, reader: Any) -> str | None:
    """The axes, which a legacy file's title names, and the field data of an XML file."""
    if isinstance(reader, vtkDataSetReader):
        return space_in((reader.GetHeader() or "").encode())
    if "SPACE" not in data.field_data:
        return None
    return space_in(f"SPACE={data.field_data['SPACE'][0]}".encode())


@contextmanager
def complaints_raised() -> Iterator[None]:
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
