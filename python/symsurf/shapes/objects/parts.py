"""What objects of other packages are taken apart into, and made again from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class Parts(NamedTuple):
    """What is taken of an object."""

    points: Any
    """(n, 3), as the object has them."""
    faces: Any = None
    """(m, 3) indices of points; None of a cloud."""
    colours: Any = None
    """(n, k) of the points; None where it has none."""


@dataclass(frozen=True)
class Remade:
    """How an object is made again."""

    points: NDArray[np.float64]
    """(n, 3)"""
    faces: NDArray[np.int64] | None
    """(m, 3); None of a cloud."""
    moved: bool = True
    """Whether points lie elsewhere, so that the object's normals are wrong."""
    turned: bool = False
    """Whether the faces are the object's, their last two corners exchanged."""
    face_sources: NDArray[np.int64] | None = None
    """(m,) of each face, the one of the object that its attributes come from; None where points and
    faces are the object's own."""
    given_faces: int = 0
    """How many faces ``face_sources`` are numbers of."""
    carried: Callable[[NDArray[Any]], NDArray[Any]] | None = None
    """Attributes of the points, from those of the object's; None: they stay."""
    keeps_texture: bool = False
    """Whether texture coordinates stay as they are, whatever is carried."""
    arrays: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    """New attributes of the points."""
    face_arrays: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    """New attributes of the faces."""
    figures: Mapping[str, Any] = field(default_factory=dict)
    """New attributes of the whole."""

    @property
    def is_other(self) -> bool:
        """Whether points and faces are others than those of the object."""
        return self.face_sources is not None

    def of_points(self, values: Any) -> NDArray[Any]:
        """Attributes of the points, from those of the object's."""
        array = np.asarray(values)
        return array if self.carried is None else self.carried(array)

    def of_faces(self, values: Any) -> NDArray[Any]:
        """Attributes of the faces, from those of the object's."""
        array = np.asarray(values)
        return array if self.face_sources is None else array[self.face_sources]
