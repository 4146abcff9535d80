"""What objects of other packages are taken apart into, and made again from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...base.input_warning import warn_of
from ..kinds import UNDIRECTED, Carry, is_ambiguous, kept_as_number


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
    carried: Carry | None = None
    """Attributes of the points, from those of the object's; None: they stay."""
    keeps: bool = True
    """Whether attributes without directions stay as they are."""
    turns: bool = False
    """Whether directions change."""
    carries_normals: bool = False
    """Whether normals at points that are moved or added are those of their sources, carried."""
    kinds: Mapping[str, str] = field(default_factory=dict)
    """Those of attributes of the points, by name, that are given."""
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

    def of_points(self, values: Any, name: object = "", kind: str | None = None) -> NDArray[Any]:
        """Attributes of the points, from those of the object's. Their kind is the one given for their
        name, or else that which the object knows; an InputWarning names those that may be
        directions of which neither says it."""
        array = np.asarray(values)
        known = self.kinds.get(str(name), kind)
        if known is None and self.turns and is_ambiguous(str(name), array):
            warn_of([kept_as_number(str(name))])
        stays = self.keeps and (known in (None, *UNDIRECTED) or not self.turns)
        return (
            array if self.carried is None or stays else self.carried(array, known or "scalar", name)
        )

    def of_faces(self, values: Any) -> NDArray[Any]:
        """Attributes of the faces, from those of the object's."""
        array = np.asarray(values)
        return array if self.face_sources is None else array[self.face_sources]
