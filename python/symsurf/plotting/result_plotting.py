"""Pictures of detections, with PyVista."""

from __future__ import annotations

import os
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput
from ..mirror_operations.operate import operate
from ..results import Result, outputs
from ..results.mirror_mesh import mirror_mesh
from ..shapes import Shape
from .drawing import (
    COLOURS,
    add_title,
    colour_map,
    draw_mirror,
    draw_scalars,
    finite_object,
    import_pyvista,
    place_camera,
    prepare,
    range_of,
    require_positive,
    show_or_write,
)

if TYPE_CHECKING:
    import pyvista


@outputs.plot.register(Result)
def plot(
    result: Result,
    path: str | os.PathLike[str] | None = None,
    *,
    shape: Shape | None = None,
    points: ArrayLike | None = None,
    clim: float | None = None,
    camera: Any = None,
    score: bool = True,
) -> pyvista.Plotter:
    """Draws a result; see ``Result.plot``."""
    require_positive(clim)

    def draw_result(plotter: pyvista.Plotter) -> None:
        title = _title(result) if score else ""
        draw(
            plotter,
            result,
            shape=shape,
            points=points,
            residual_range=clim,
            camera=camera,
            title=title,
        )

    return show_or_write(path, draw_result)


def draw(
    plotter: pyvista.Plotter,
    result: Result,
    *,
    shape: Shape | None = None,
    points: ArrayLike | None = None,
    residual_range: float | None = None,
    camera: Any = None,
    title: str = "",
) -> None:
    """Adds a result to a plotter and looks at it.

    Args:
        plotter: with its own size and layout.
        shape, points: the object; without them, the points and faces of the detection.
        residual_range: what the colours end at, in % of the diagonal; without it, what 98 % of the
            values stay below.
        camera: as for ``Result.plot``.
        title: a line above the picture.
    """
    object_, values, title_of_bar = _object(result, shape, points)
    seen = _without_outliers(result, object_)
    prepare(plotter)
    # The normals of a few large faces are no surface to shade smoothly.
    smooth = "surface_samples" not in result.statistics
    percent = 100 * values / seen.length
    ends = 0, range_of(percent) if residual_range is None else residual_range
    bar = f"{title_of_bar}, % of the diagonal"
    draw_scalars(plotter, object_, percent, bar, ends, colour_map(COLOURS), smooth)
    vertices, triangles = mirror_mesh(result, seen.points)
    draw_mirror(plotter, vertices, triangles)
    add_title(plotter, title)
    drawn = np.vstack([seen.points, vertices])
    place_camera(plotter, camera, result.mirror, seen.points, drawn, title)


def _title(result: Result) -> str:
    """Verdict, kind and score; nothing if no verdict was computed."""
    if "verdict" not in result.statistics:
        return ""
    kind = result.mirror.kind if result.mirror is not None else "no mirror"
    return f"{result.verdict}: {kind}, score {result.score:.2f}"


def _object(
    result: Result, shape: Shape | None, points: ArrayLike | None
) -> tuple[pyvista.PolyData, NDArray[np.float64], str]:
    """What is drawn, a value of each of its points, and what that is; points that are not finite
    cannot be drawn. Residuals depend on where the points lie on the surface, so they are drawn only
    if the asymmetry cannot be measured."""
    if shape is None:
        chosen = result.points if points is None else points
        if chosen is None:
            raise InvalidInput("the result does not know its points: give shape or points")
        faces = result.faces if points is None else None
        shape = Shape(np.asarray(chosen, dtype=float), faces)
    values, name = _residuals(result, len(shape.points)), "residual"
    object_, rows = finite_object(shape)
    if result.mirror is not None and len(result.pairs):
        with suppress(InvalidInput):
            values, name = (
                operate("asymmetry", shape, result.mirror).arrays["distance"],
                "asymmetry",
            )
    return object_, values[rows], name


def _without_outliers(result: Result, object_: pyvista.PolyData) -> pyvista.PolyData:
    """What a picture should show: the object, or its points without those that lie far off."""
    outliers = result.statistics.get("outliers", 0)
    if not outliers:
        return object_
    points = np.asarray(object_.points)
    distances = np.linalg.norm(points - np.median(points, axis=0), axis=1)
    return import_pyvista().PolyData(points[np.argsort(distances, kind="stable")[:-outliers]])


def _residuals(result: Result, count: int) -> NDArray[np.float64]:
    """Of each point; NaN where it has no partner."""
    if len(result.pairs) and result.pairs.max() >= count:
        raise InvalidInput(f"the result has pairs beyond the {count} points given")
    residuals = np.full(count, np.nan)
    residuals[result.pairs[:, 0]] = result.residuals
    return residuals
