"""Point sets and meshes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..base.optional import require

if TYPE_CHECKING:
    import pyvista


@dataclass(frozen=True)
class SourceFile:
    """The file that a shape was read from."""

    path: Path
    suffix: str
    """Of its format, such as ".ply" or ".ply.gz"."""
    content: bytes | None = None
    """Of what was read from memory; None: it is in the file."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A mesh or point cloud, in the units and order of its file."""

    points: NDArray[np.float64]
    """(n, 3), as they stand in the file: some may not be finite."""
    faces: NDArray[np.int64] | None = None
    """(m, 3) indices of points, polygons as fans of triangles; None for a bare cloud."""
    normals: NDArray[np.float64] | None = None
    """(n, 3) as the file gives them; None where it gives none."""
    space: str | None = None
    """"RAS" or "LPS" where the file says which way its axes point; None where it does not."""
    colours: NDArray[np.float64] | None = None
    """(n, k), one channel per column, as the file gives them; None where it gives none."""
    weights: NDArray[np.float64] | None = None
    """(n,) how much each point counts for ``detect``, 0 to 1: the opacity of Gaussian splats."""

    polygons: NDArray[np.int64] | None = None
    """(m,) the number of the polygon that each triangle is a part of; None where all polygons of the
    file are triangles, or none are known."""
    source: SourceFile | None = None
    """The file, of which ``save`` of a result keeps what it can; None where the shape is of none."""

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """The points: ``np.asarray(shape)``."""
        return np.array(self.points, dtype) if copy else np.asarray(self.points, dtype)

    def __repr__(self) -> str:
        faces = "no faces" if self.faces is None else f"{len(self.faces)} faces"
        normals = "no normals" if self.normals is None else "normals"
        return f"Shape({len(self.points)} points, {faces}, {normals})"

    @classmethod
    def from_pyvista(cls, mesh: pyvista.DataSet) -> Shape:
        """The points of a data set, the faces of its flat cells as triangles, its point normals and
        colours: the active point scalars, if they are integers with 3 or 4 channels. Raises
        InvalidInput for other objects than data sets of PyVista; ImportError without PyVista.
        """
        require("PyVista's meshes", "pyvista")
        from .grids import colours_of, shape_of

        return cls(*shape_of(mesh), colours=colours_of(mesh))

    def to_pyvista(self) -> pyvista.PolyData:
        """The faces, or the points of a bare cloud as vertices, in double precision; the normals are
        the active ones. ``from_pyvista`` makes the same shape of it. Needs PyVista."""
        require("PyVista's meshes", "pyvista")
        from .grids import poly_data

        return poly_data(self.points, self.faces, self.normals)
