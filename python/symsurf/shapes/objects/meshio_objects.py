"""meshio's meshes."""

from __future__ import annotations

from typing import Any

import meshio
import numpy as np
from numpy.typing import NDArray

from .parts import Parts, Remade


def parts_of(given: Any) -> Parts:
    """Faces are its triangles and quadrangles, these divided; a body's cells are none."""
    faces = [_triangles(block.data) for block in given.cells if block.type in ("triangle", "quad")]
    return Parts(given.points, np.vstack(faces) if faces else None)


def remade(given: Any, made: Remade) -> Any:
    """Its triangles, with the arrays of its points. Quadrangles are divided."""
    cells = [] if made.faces is None else [("triangle", made.faces)]
    kept = {name: made.of_points(values, name) for name, values in given.point_data.items()}
    of_faces = (
        {name: [np.asarray(values)] for name, values in made.face_arrays.items()} if cells else {}
    )
    return meshio.Mesh(made.points, cells, point_data=kept | dict(made.arrays), cell_data=of_faces)


def _triangles(corners: NDArray[Any]) -> NDArray[Any]:
    if corners.shape[1] == 3:
        return corners
    return corners[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
