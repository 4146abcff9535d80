"""What a detection found."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import Mirror

if TYPE_CHECKING:
    from pyvista import Plotter

    from .shape import Shape


@dataclass(frozen=True, eq=False)
class Result:
    """What a detection found. No symmetry is a result too: one with a low score."""

    method: str
    """The method that found it."""
    mirror: Mirror | None
    """None where none is found, and for methods that find surface points only."""
    surface_points: NDArray[np.float64] = field(repr=False)
    """(m, 3) midpoints of the pairs, at most half a residual off the mirror; ``perpendicular``,
    ``quadric`` and ``fixed_direction`` project them onto it. Input units."""
    pairs: NDArray[np.int64] = field(repr=False)
    """(m, 2) indices into the input: a point, and the point its image falls on."""
    residuals: NDArray[np.float64] = field(repr=False)
    """(m,) distances from the image to the partner; input units."""
    score: float
    """0: no symmetry, 1: exact."""
    candidates: list[Result] = field(repr=False)
    """Other mirrors, best first as the method sees it, which looks closer than the score: one may
    score more than the result. Without pairs; ``match`` gives them theirs."""
    parameters: dict[str, Any]
    """Every parameter of the method, as used."""
    statistics: dict[str, Any] = field(repr=False)
    """Whatever else the method reports, and "stray_points" where some points lie so far off that
    they were left out: how many. They have no partners. "skin_points" where the points fill a
    body, and the mirror and the score are those of its skin: how many it has."""
    seconds: float
    points: NDArray[np.float64] | None = field(default=None, repr=False)
    """(n, 3) the input: the caller's own array where it could be read in place."""

    @classmethod
    def from_fields(cls, fields: dict[str, Any]) -> Result:
        """A result from its fields by name, the candidates likewise."""
        candidates = [cls.from_fields(candidate) for candidate in fields["candidates"]]
        return cls(**fields | {"candidates": candidates})

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the result, in the format of the suffix.

        ``.json``: everything but ``points``; of a candidate its method, mirror and score. ``.vtp``:
        mirror, surface points, pairs and residuals for VTK and ParaView. ``.ply``: surface points
        with residuals as quality. ``.txt``: comment lines starting with ``#``, then the surface
        points, x,y,z a line; a sphere as its centre, then its radius.

        Raises InvalidParameter for another suffix, OSError where nothing can be written. A file is
        written whole or not at all.
        """
        from .saving import save

        save(self, path)

    def plot(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        shape: Shape | None = None,
        points: ArrayLike | None = None,
    ) -> Plotter:
        """Draws the object coloured by residual, and its mirror translucent; needs PyVista.

        Args:
            path: a PNG to write off-screen; without it a window opens.
            shape: the object as it was read, whose faces are then drawn.
            points: the object's points (n, 3); without them, those of the detection.
        """
        from .plotting import plot

        return plot(self, path, shape=shape, points=points)
