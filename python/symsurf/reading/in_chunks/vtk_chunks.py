"""Data of VTK in pieces: PVTP, and VTKHDF in its partitions."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import iterparse

import numpy as np
import pyvista
from numpy.typing import NDArray
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from ..._core import InvalidInput
from ...base.options import Reading
from ...base.own_process import one_more_file
from ..location import referenced
from ..vtk_data import complaints_raised
from . import FileChunks

_PIECES = 64  # in as many VTK shares out what a file has; some may be empty


def chunks_of(path: Path, reading: Reading) -> FileChunks:
    if path.suffix.lower() == ".pvtp":
        files = [referenced(name, path, reading) for name in _sources(path)]
        return FileChunks(
            None, lambda: (_points(vtkXMLPolyDataReader, file, 0, 1) for file in files)
        )
    _partition(path, 0, reading)  # so that what is no such file is reported at once
    return FileChunks(None, lambda: _partitions(path, reading))


def _sources(path: Path) -> list[str]:
    """The names of the files with the pieces."""
    elements = [element for _, element in iterparse(path)]
    if not elements or elements[-1].get("type") != "PPolyData":
        raise InvalidInput("this is no file of VTK with pieces of poly data")
    pieces = [element for element in elements if element.tag == "Piece"]
    return [name for piece in pieces if (name := piece.get("Source"))]


def _partitions(path: Path, reading: Reading) -> Iterator[NDArray[np.float64]]:
    count = 0
    for number in range(_PIECES):
        points = _partition(path, number, reading)
        count += len(points)
        yield points
    if not count:
        raise InvalidInput(
            "VTK finds no points in it; those of other files that it names are read with "
            "external_files=True alone"
        )


def _partition(path: Path, number: int, reading: Reading) -> NDArray[np.float64]:
    """VTK would follow any link to any file."""
    with one_more_file(not reading.external_files):
        return _points(vtkHDFReader, path, number, _PIECES)


def _points(kind: Any, path: Path, number: int, pieces: int) -> NDArray[np.float64]:
    reader = kind()
    reader.SetFileName(str(path))
    with complaints_raised():
        reader.UpdateInformation()
        reader.UpdatePiece(number, pieces, 0)
    data = pyvista.wrap(reader.GetOutputDataObject(0))
    parts = [data] if hasattr(data, "points") else [part for part in data if part is not None]
    return np.concatenate([np.empty((0, 3)), *(np.asarray(part.points) for part in parts)])
