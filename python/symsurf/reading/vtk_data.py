"""VTK's data sets, by PyVista: VTP, VTU, VTI and the legacy VTK."""

from __future__ import annotations

from pathlib import Path

import pyvista

from .._core import InvalidInput, InvalidParameter
from ..grids import is_grid, points_above
from ..shape import Shape


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    """Points, flat cells as triangles and point normals; of a regular grid what the threshold
    chooses of it."""
    # VTK tells what is wrong with a file beside giving what it has read of it.
    with pyvista.VtkErrorCatcher(raise_errors=True, send_to_logging=False):
        data = pyvista.read(path)
    if not isinstance(data, pyvista.DataSet):
        raise InvalidInput(f"it holds a {type(data).__name__}; allowed is a data set")
    if is_grid(data):
        return Shape(points_above(data, threshold, scalars))
    for name, value in (("threshold", threshold), ("scalars", scalars)):
        if value is not None:
            raise InvalidParameter(f"{name} is {value!r}; allowed is None, as this is no image")
    return Shape.from_pyvista(data)
