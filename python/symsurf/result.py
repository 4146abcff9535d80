"""What a detection found."""

from __future__ import annotations

import os
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import Mirror

if TYPE_CHECKING:
    from pyvista import Plotter

    from .shape import Shape


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """What a detection found. No symmetry is a result too: one with a low score."""

    method: str
    """The method that found it."""
    mirror: Mirror | None
    """None where none is found, and for methods that find surface points only."""
    surface_points: NDArray[np.float64]
    """(m, 3) midpoints of the pairs, at most half a residual off the mirror; ``perpendicular``,
    ``quadric`` and ``fixed_direction`` project them onto it. Input units."""
    pairs: NDArray[np.int64]
    """(m, 2) indices into the input: a point, and the point its image falls on."""
    residuals: NDArray[np.float64]
    """(m,) distances from the image to the partner; input units."""
    score: float
    """0: no symmetry, 1: exact. The share of the shape that the mirror maps onto it."""
    candidates: list[Result]
    """Other mirrors, by score; none scores more than the result. Without pairs; ``match`` gives them
    theirs."""
    parameters: dict[str, Any]
    """Every parameter of the method, as used."""
    statistics: dict[str, Any]
    """Whatever else the method reports, and, where there are some, how many "nonfinite_points" were
    left out as not finite and how many "outliers" as lying far off: they have no partners.
    "surface_samples": how many points were added on the faces. "boundary_points" of a volumetric
    cloud, where the mirror and the score are those of its boundary: how many it has. "warning": what
    the method is not for, which was an ``InputWarning``."""
    seconds: float
    points: NDArray[np.float64] | None = None
    """(n, 3) the input: the caller's own array where it could be read in place. Of a grid the points
    that were chosen, which ``pairs`` are indices into."""
    faces: NDArray[np.int64] | None = None
    """(m, 3) the triangles between them; None for a bare cloud."""

    @property
    def verdict(self) -> str:
        """Either "found" where there is a mirror, "none" where there is none, or where nobody judged."""
        return self.statistics.get("verdict", "none")

    @property
    def reason(self) -> str:
        """Why, in a sentence; "" where nobody judged."""
        return self.statistics.get("reason", "")

    @property
    def summary(self) -> dict[str, str]:
        """What it says in a few words, by name: mirror, score, verdict, paired, median residual."""
        words = {"mirror": self.mirror.kind if self.mirror is not None else "none"}
        if "verdict" in self.statistics:
            words |= {"verdict": self.verdict, "reason": self.reason}
        words["score"] = f"{self.score:.3f}"
        if self.points is not None:
            count, paired = len(self.points), len(self.pairs)
            words["paired"] = f"{_percent(paired, count)} of {count} points"
        if len(self.residuals):
            words["median residual"] = f"{np.median(self.residuals):.3g}"
        words["method"] = self.method
        return words

    def __repr__(self) -> str:
        words = [f"{name}: {text}" for name, text in self.summary.items() if name != "reason"]
        return f"Result({', '.join(words)})"

    def __str__(self) -> str:
        return "\n".join(f"{name:<16} {text}" for name, text in self.summary.items())

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>"
            for name, text in self.summary.items()
        )
        return f"<table>{rows}</table>"

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
        """Draws the object coloured by residual, its mirror translucent, and the verdict above;
        needs PyVista.

        Args:
            path: a PNG to write off-screen, whole or not at all; without it a window opens.
            shape: another object with as many points, with its faces.
            points: its points (n, 3) alone; without both, the points and faces of the detection.
        """
        from .plotting import plot

        return plot(self, path, shape=shape, points=points)


def _percent(part: int, whole: int) -> str:
    """Never 100 % of less than all."""
    share = np.floor(1000 * part / whole) / 10 if whole else 0.0
    return f"{share:g} %"
