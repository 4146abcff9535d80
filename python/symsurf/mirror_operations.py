"""What is done with a mirror: one function for each of ``operations()``.

>>> asymmetry = symsurf.asymmetry("skull.ply")
>>> asymmetry.statistics["rms"], asymmetry.distance.max()
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._core import InvalidInput, InvalidParameter, Mirror
from .detection import Progress, detect
from .inputs import Input, as_input
from .result import Result
from .shape import Shape

__all__ = [
    "Alignment",
    "Asymmetry",
    "Correspondences",
    "OperationResult",
    "Straightened",
    "Symmetrized",
    "align",
    "asymmetry",
    "correspondences",
    "straighten",
    "symmetrize",
]


@dataclass(frozen=True, eq=False)
class OperationResult:
    """What an operation gives."""

    shape: Shape
    """The shape, moved or not: its points and faces in the order of the input."""
    mirror: Mirror
    """The mirror that was used."""
    parameters: dict[str, Any] = field(repr=False)
    """Every parameter of the operation, as used."""
    statistics: dict[str, Any]
    """Whatever else the operation reports."""

    @property
    def arrays(self) -> dict[str, NDArray[Any]]:
        """What the operation gives each point, by name."""
        shared = {each.name for each in fields(OperationResult)}
        own = {e.name: getattr(self, e.name) for e in fields(self) if e.name not in shared}
        return {name: values for name, values in own.items() if values is not None}

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the shape with ``arrays``, in the format of the suffix, whole or not at all.

        ``.ply``: binary, arrays as properties of the points. ``.vtp``: for VTK, ParaView and PyVista,
        which read no such properties. Raises InvalidParameter for another suffix, OSError where
        nothing can be written.
        """
        from .saving import SHAPE_FORMATS, write_whole

        path = Path(path)
        suffix = path.suffix.lower()
        if suffix not in SHAPE_FORMATS:
            raise InvalidParameter(
                f"path is {str(path)!r}; allowed are the suffixes {', '.join(SHAPE_FORMATS)}"
            )
        write_whole(path, SHAPE_FORMATS[suffix](self.shape, self.arrays))


@dataclass(frozen=True, eq=False)
class Asymmetry(OperationResult):
    """How far each point is from where the other side says it should be.

    ``statistics``: "matched_share"; over the matched points "mean", "rms", "median", "p75", "p95",
    "p99" and "maximum" of the distances, "signed_mean" and "signed_deviation", in input units and,
    with "_of_diagonal" behind the name, as shares of the "diagonal"; of a mesh "positive_area" and
    "negative_area" with "area_index", (positive - negative) / (positive + negative); of a
    watertight one the same of the volume. 0 means symmetric.
    """

    vector: NDArray[np.float64] = field(repr=False)
    """(n, 3) from the point to its place, input units; NaN without a counterpart."""
    distance: NDArray[np.float64] = field(repr=False)
    """(n,) its length."""
    signed: NDArray[np.float64] = field(repr=False)
    """(n,) its part along the outward normal: positive where the point lies too far in."""
    lateral: NDArray[np.float64] = field(repr=False)
    """(n,) its part away from the mirror."""
    matched: NDArray[np.bool_] = field(repr=False)
    """(n,) whether the point has a counterpart: none past a rim, too far away, or with another
    normal."""


@dataclass(frozen=True, eq=False)
class Correspondences(OperationResult):
    """Which point mirrors which. ``statistics``: "paired_share"."""

    index: NDArray[np.int64] = field(repr=False)
    """(n,) the mirror point, the point itself on the mirror, -1 for none."""
    confidence: NDArray[np.float64] = field(repr=False)
    """(n,) 0 to 1: the cosine between the normals, halved where the image lies a spacing away."""
    face: NDArray[np.int64] | None = field(default=None, repr=False)
    """(n,) of a mesh, the face that the image comes closest to; -1 for none."""
    weights: NDArray[np.float64] | None = field(default=None, repr=False)
    """(n, 3) of a mesh, the barycentric coordinates on that face."""


@dataclass(frozen=True, eq=False)
class Alignment(OperationResult):
    """The shape laid so that its mirror plane is a coordinate plane."""

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(4, 4), a rotation and a shift, never a reflection: ``matrix @ (x, y, z, 1)``."""
        return self.statistics["matrix"]


@dataclass(frozen=True, eq=False)
class Symmetrized(OperationResult):
    """The shape made symmetric. ``statistics``: "paired_share"."""

    paired: NDArray[np.bool_] = field(repr=False)
    """(n,) whether the point has a counterpart; else it stays."""


@dataclass(frozen=True, eq=False)
class Straightened(OperationResult):
    """The shape with its mirror laid flat. ``statistics``: "normal" and "offset" of the plane that
    the mirror is then, and how many "unplaced_points" have no foot on it: they are NaN."""

    @property
    def plane(self) -> _core.Plane:
        """The plane that the mirror is laid into."""
        return _core.Plane(self.statistics["normal"], self.statistics["offset"])


def asymmetry(
    shape: object,
    result: Result | Mirror | None = None,
    *,
    faces: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Asymmetry:
    """Measures for each point how far it is from where the other side says it should be: the mirror
    image of the closest point on the surface, on the triangles of a mesh, to its own image.

    Args:
        shape: points, a mesh or a file, as ``detect`` takes them; all points finite.
        result: what ``detect`` found, or a mirror of any kind, in the unit and pose of the points;
            without it the mirror is found first.
        faces: (m, 3) indices of points, where ``shape`` does not bring them.
        threads, progress: as for ``detect``.
        **parameters: the operation's own, by name: ``operations()["asymmetry"].parameters``.

    Raises:
        InvalidInput: no mirror is found, or it has images for less than half of the points; a point
            that is not finite; else as ``detect`` does.
        InvalidParameter, Cancelled: as ``detect`` does.
    """
    made = _operate("asymmetry", shape, result, faces, None, threads, progress, parameters)
    return Asymmetry(**made)


def correspondences(
    shape: object,
    result: Result | Mirror | None = None,
    *,
    faces: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Correspondences:
    """Gives for each point the point that mirrors it; with ``one_to_one=True`` only pairs of points
    that are each other's. Arguments and errors: those of ``asymmetry``.
    """
    made = _operate("correspondences", shape, result, faces, None, threads, progress, parameters)
    return Correspondences(**made)


def align(
    shape: object,
    result: Result | Mirror | None = None,
    *,
    faces: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Alignment:
    """Turns and shifts the shape so that its mirror plane, or the plane nearest to a mirror that
    bends, is a coordinate plane: x = 0, or across another ``axis``. ``frame`` says how to turn
    about that axis, ``up`` and ``front`` which way is up and to the front. Other arguments and
    errors: those of ``asymmetry``.
    """
    return Alignment(**_operate("align", shape, result, faces, None, threads, progress, parameters))


def symmetrize(
    shape: object,
    result: Result | Mirror | None = None,
    *,
    mask: ArrayLike | None = None,
    faces: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Symmetrized:
    """Moves the points so that the mirror maps the shape onto itself: halfway between the sides, or
    with ``side="positive"`` or ``"negative"`` the other side onto the image of that one.

    Args:
        mask: (n,) in [0, 1], or booleans: how far each point may move.
        shape, result, faces, threads, progress, **parameters: as for ``asymmetry``.

    Raises:
        InvalidInput: a mask that is not one number in [0, 1] a point; else as ``asymmetry`` does.
    """
    made = _operate("symmetrize", shape, result, faces, mask, threads, progress, parameters)
    return Symmetrized(**made)


def straighten(
    shape: object,
    result: Result | Mirror | None = None,
    *,
    faces: ArrayLike | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Straightened:
    """Carries the shape along while its curved mirror is laid flat, or, with ``back=True``, back.
    Arguments and errors: those of ``asymmetry``.
    """
    made = _operate("straighten", shape, result, faces, None, threads, progress, parameters)
    return Straightened(**made)


def _operate(
    name: str,
    given: object,
    result: Result | Mirror | None,
    faces: ArrayLike | None,
    mask: ArrayLike | None,
    threads: int,
    progress: Progress | None,
    parameters: dict[str, object],
) -> dict[str, Any]:
    shape = as_input(given, faces)
    mirror = _mirror_of(shape, result, threads)
    made = _core.operate(
        name, shape.points, shape.faces, mirror, _mask_of(mask), threads, progress, parameters
    )
    arrays = made.pop("arrays")
    points, triangles = made.pop("points"), made.pop("faces")
    del made["point_sources"], made["face_sources"]
    return (
        made
        | arrays
        | {"mirror": mirror, "shape": Shape(points, triangles if len(triangles) else None)}
    )


def _mask_of(mask: ArrayLike | None) -> NDArray[np.float64] | None:
    if mask is None:
        return None
    try:
        values = np.asarray(mask, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"mask cannot be read as real numbers: {error}") from None
    if values.ndim != 1:
        raise InvalidInput(f"mask has shape {values.shape}; allowed is (n,)")
    return values


def _mirror_of(shape: Input, result: Result | Mirror | None, threads: int) -> Mirror:
    if isinstance(result, Mirror):
        return result
    if result is None:
        found = detect(shape.points, faces=shape.faces, threads=threads)
        if found.verdict != "found":
            raise InvalidInput(
                f"the shape has no mirror: {found.reason}; give a result or a mirror to use it all "
                "the same"
            )
        result = found
    if not isinstance(result, Result):
        raise InvalidParameter(
            f"result is of type {type(result).__name__}; allowed is a Result, a Mirror or None"
        )
    if result.mirror is None:
        raise InvalidInput(f"the result of {result.method} has no mirror")
    return result.mirror
