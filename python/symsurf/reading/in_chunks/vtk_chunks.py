"""Data of VTK in pieces: PVTP, and VTKHDF in its partitions."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyvista
from numpy.typing import NDArray
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLPPolyDataReader

from ..vtk_data import complaints_raised
from . import FileChunks

_READERS: dict[str, Any] = {".pvtp": vtkXMLPPolyDataReader, ".vtkhdf": vtkHDFReader}
_PIECES = 64  # in as many VTK shares out what a file has; some may be empty


def chunks_of(path: Path) -> FileChunks:
    _piece(path, 0)  # so that what is no such file is told at once

    def pieces() -> Iterator[NDArray[np.float64]]:
        return (_piece(path, number) for number in range(_PIECES))

    return FileChunks(None, pieces)


def _piece(path: Path, number: int) -> NDArray[np.float64]:
    reader = _READERS[path.suffix.lower()]()
    reader.SetFileName(str(path))
    with complaints_raised():
        reader.UpdateInformation()
        reader.UpdatePiece(number, _PIECES, 0)
    data = pyvista.wrap(reader.GetOutputDataObject(0))
    parts = [data] if hasattr(data, "points") else [part for part in data if part is not None]
    return np.concatenate([np.empty((0, 3)), *(np.asarray(part.points) for part in parts)])
