"""What a detection found."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput, Mirror
from ..base.plain import plain
from ..reading.json_records import result_fields
from ..shapes import Shape
from .base_result import BaseResult, mirror_record
from .outputs import plot
from .summary import percent

if TYPE_CHECKING:
    from pyvista import Plotter
    from typing_extensions import TypeVar  # where ``Result`` alone is one of any mirror

    Kind_co = TypeVar("Kind_co", bound=Mirror, default=Mirror, covariant=True)
else:
    from typing import TypeVar

    Kind_co = TypeVar("Kind_co", bound=Mirror, covariant=True)


@dataclass(frozen=True, eq=False, repr=False)
class Result(BaseResult, Generic[Kind_co]):
    """The result of a detection. "No symmetry" is a result, too: one with a low score.

    ``detect_plane`` gives a ``Result[Plane]``, and so on.
    """

    method: str
    """The method that found it."""
    mirror: Kind_co | Any
    """A ``Mirror``; None if none is found, and for methods that find surface points only. A
    ``Plane`` has the points x with ``normal @ x + offset == 0``: ``offset`` is minus the distance
    from the
    origin along the unit normal. ``signed_distance`` is positive on the side that the normal points to."""
    surface_points: NDArray[np.float64]
    """(m, 3) midpoints of the pairs, at most half a residual off the mirror; ``perpendicular``,
    ``quadric`` and ``fixed_direction`` project them onto it. Input units."""
    pairs: NDArray[np.int64]
    """(m, 2) indices into the input: a point, and the point its image falls on."""
    residuals: NDArray[np.float64]
    """(m,) distances from the image to the partner; input units."""
    score: float
    """0: no symmetry, 1: as good as the sampling shows. The share of the shape that the mirror maps
    onto its surface, over the share that passes the same test without a mirror. The rest has no
    counterpart, "missing_share" of the statistics, or differs from it, "contradicted_share". Of
    height fields and free forms it is multiplied by the probability that chance did not make them."""
    candidates: list[Result[Kind_co]]
    """Other mirrors, by score; none scores more than the result. Without pairs; ``match`` gives them
    theirs."""
    parameters: dict[str, Any]
    """Every parameter of the method, as used."""
    statistics: dict[str, Any]
    """Other figures of the method, among them:

    - "mapped_share", "missing_share" and "contradicted_share" of the points that the mirror moves, 0 to 1;
      their sum is 1;
    - "exact_share": points whose image is a point of the shape, 0 to 1;
    - "deviation": median distance of mapped images from the surface of the shape, input units;
    - "evidence": whether the mirror maps the shape better than the same mirror turned and shifted, 0 to 1;
      "deciding_share": points that distinguish the mirror from these, 0 to 1;
    - "nonfinite_points" and "outliers": numbers of points that were ignored and have no partners;
    - "surface_samples": number of points sampled on the faces; "boundary_points": number of points on the
      boundary of a volumetric cloud; mirror and score are then those of the samples or of the boundary;
    - "warning": why the method is not suited to the input, which was an ``InputWarning``."""
    seconds: float
    """Run time in seconds."""
    points: NDArray[np.float64] | Any = None
    """(n, 3) the input: the caller's own array where it could be read in place. For a grid the points
    that were chosen, which ``pairs`` are indices into. None of a candidate and of what ``load`` has read."""
    faces: NDArray[np.int64] | None = None
    """(m, 3) the triangles between them; None for a bare cloud."""
    space: str | None = None
    """"RAS" or "LPS", the axes of the input where they are known; see ``Shape``."""

    @property
    def shape(self) -> Shape:
        """The input. Raises InvalidInput for a candidate and for a result that ``load`` has read."""
        if self.points is None:
            raise InvalidInput("the result has no points; those of the detection are needed")
        return Shape(self.points, self.faces, space=self.space)

    @property
    def arrays(self) -> dict[str, NDArray[Any]]:
        """For each point (n,): "partner", index of the point at its image, -1 for none; "residual",
        the distance between both in input units, NaN for none."""
        partner = np.full(len(self.shape.points), -1)
        residual = np.full(len(partner), np.nan)
        partner[self.pairs[:, 0]] = self.pairs[:, 1]
        residual[self.pairs[:, 0]] = self.residuals
        return {"partner": partner, "residual": residual}

    @property
    def point_count(self) -> int:
        """Number of input points, including points that are not finite and points lost by
        downsampling."""
        if "summarized_points" not in self.statistics:
            return len(self.points)
        return self.statistics["summarized_points"] + self.statistics.get("nonfinite_points", 0)

    @property
    def verdict(self) -> str:
        """ "found", or "none" if no mirror was found or no verdict was computed."""
        return self.statistics.get("verdict", "none")

    @property
    def reason(self) -> str:
        """Reason of the verdict, in a sentence; "" if no verdict was computed."""
        return self.statistics.get("reason", "")

    @property
    def summary(self) -> dict[str, str]:
        """A short text per name: mirror, score, verdict, paired, median residual."""
        words = {"mirror": self.mirror.kind if self.mirror is not None else "none"}
        if "verdict" in self.statistics:
            words |= {"verdict": self.verdict, "reason": self.reason}
        words["score"] = f"{self.score:.3f}"
        if self.points is not None and self.parameters.get("pairs", True):
            count, paired = len(self.points), len(self.pairs)
            words["paired"] = f"{percent(paired / count if count else 0)} of {count} points"
        if len(self.residuals):
            words["median residual"] = f"{np.median(self.residuals):.3g}"
        words["method"] = self.method
        return words

    def __repr__(self) -> str:
        words = [f"{name}: {text}" for name, text in self.summary.items() if name != "reason"]
        return f"Result({', '.join(words)})"

    def to_json(self) -> dict[str, Any]:
        """The result without its points: a few lines, however large the input."""
        return self._outline() | {
            **super().to_json(),
            "candidates": [candidate._outline() for candidate in self.candidates],
        }

    def json_arrays(self) -> dict[str, Any]:
        return {
            "pairs": plain(self.pairs),
            "residuals": plain(self.residuals),
            "surface_points": plain(self.surface_points),
            "space": self.space,
            "footprint": None if self.mirror is None else plain(self.mirror.footprint),
        }

    def _outline(self) -> dict[str, Any]:
        return {
            "method": self.method,
            "mirror": mirror_record(self.mirror),
            "score": plain(self.score),
        }

    @classmethod
    def from_fields(cls, fields: dict[str, Any]) -> Result:
        """A result from its fields by name, the candidates likewise."""
        space = fields.get("space")
        candidates = [cls.from_fields(each | {"space": space}) for each in fields["candidates"]]
        return cls(**fields | {"candidates": candidates})

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the result, in the format of the suffix.

        ``.json``: everything but ``points`` and ``faces``, for ``load``; of a candidate its method,
        mirror and score. ``.vtp``:
        mirror, surface points, pairs and residuals for VTK and ParaView. ``.stl``, ``.obj``, ``.off``
        and ``.glb``: the mirror as triangles over the shape. ``.ply``: surface points
        with residuals as quality. ``.txt``: comment lines starting with ``#``, then the surface
        points, x,y,z a line; a sphere as its centre, then its radius. Each but GLB names the axes
        where ``space`` does.

        Raises InvalidParameter for another suffix, InvalidInput for the triangles of no mirror,
        OSError where nothing can be written. A file is written whole or not at all.
        """
        super().save(path)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Result[Mirror]:
        """Reads what ``save`` wrote as ``.json``, to the last digit, without ``points`` and
        ``faces``.

        Raises InvalidParameter for another suffix, InvalidInput, naming the file, for one that is
        missing, broken or no result.
        """
        return Result.from_fields(result_fields(path))

    def plot(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        shape: Shape | None = None,
        points: ArrayLike | None = None,
        clim: float | None = None,
        camera: Sequence[float] | Any = None,
        score: bool = True,
    ) -> Plotter:
        """Draws the shape, coloured by the distance of each point from the mirrored other side,
        with a translucent mirror and the verdict as title; needs PyVista.

        Args:
            path: a PNG file to write, off-screen; None: opens a window.
            shape: another object with as many points, with its faces.
            points: its points (n, 3) alone; without both, the points and faces of the detection.
            clim: upper end of the colour scale, above 0 and in % of the diagonal; None: the 98th
                percentile, at least 0.1.
            camera: a direction (3,) to look from, with all of the shape in view, or a value of
                PyVista's ``Plotter.camera_position``, such as "xy"; None: across the mirror, from
                above.
            score: False: omit the title.
        """
        return plot(self, path, shape=shape, points=points, clim=clim, camera=camera, score=score)
