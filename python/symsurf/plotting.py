"""Pictures of results, with PyVista."""

from __future__ import annotations

import os
import sys
from ctypes.util import find_library
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import InvalidInput, InvalidParameter
from .mirror_mesh import mirror_mesh
from .result import Result
from .saving import write_whole
from .shape import Shape

if TYPE_CHECKING:
    import pyvista

SIZE = (1200, 900)
# From light to dark in even steps: an exact mirror leaves the object light.
COLOURS = ("#f5e6c8", "#f0bd80", "#de8350", "#b4464b", "#74204f")
UNPAIRED = "#9aa3ad"
MIRROR = "#2f7fd0"
BACKGROUND = "#ffffff"
INK = "#333333"


def plot(
    result: Result,
    path: str | os.PathLike[str] | None = None,
    *,
    shape: Shape | None = None,
    points: ArrayLike | None = None,
) -> pyvista.Plotter:
    """Draws a result; see ``Result.plot``."""
    if path is not None and Path(path).suffix.lower() != ".png":
        raise InvalidParameter(f"path is {str(path)!r}; allowed is the suffix .png")
    plotter = new_plotter(off_screen=path is not None)
    draw(plotter, result, shape=shape, points=points, title=_title(result))
    if path is None:
        plotter.show(auto_close=False)
    else:
        write_picture(plotter, Path(path))
    return plotter


def write_picture(plotter: pyvista.Plotter, path: Path) -> None:
    """As a PNG, whole or not at all; closes the plotter."""
    picture = BytesIO()
    plotter.screenshot(picture)
    plotter.close()
    write_whole(path, picture.getvalue())


def new_plotter(off_screen: bool, **options: Any) -> pyvista.Plotter:
    """A plotter of our size, without a window where off_screen."""
    if off_screen and sys.platform == "linux" and not os.environ.get("DISPLAY"):
        # VTK would try X first, and complain.
        if find_library("EGL"):
            os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    return _pyvista().Plotter(off_screen=off_screen, **{"window_size": SIZE} | options)


def draw(
    plotter: pyvista.Plotter,
    result: Result,
    *,
    shape: Shape | None = None,
    points: ArrayLike | None = None,
    residual_range: float | None = None,
    title: str = "",
) -> None:
    """Adds a result to a plotter and looks at it.

    Args:
        plotter: with its own size and layout.
        shape, points: the object; without them, the points and faces of the detection.
        residual_range: what the colours end at, in % of the diagonal; without it, what 98 % of the
            residuals stay below.
        title: a line above the picture.
    """
    object_, residuals = _object(result, shape, points)
    seen = _without_outliers(result, object_)
    plotter.set_background(BACKGROUND)
    plotter.enable_anti_aliasing("ssaa")
    plotter.enable_lightkit()
    # The normals of a few large faces are no surface to shade smoothly.
    smooth = "surface_samples" not in result.statistics
    _draw_object(plotter, object_, 100 * residuals / seen.length, residual_range, smooth)
    drawn = np.vstack([seen.points, _draw_mirror(plotter, result, seen)])
    if title:
        plotter.add_text(title, position="upper_edge", font_size=14, color=INK)
    _look(plotter, *_view(result, seen), drawn, top=0.86 if title else 0.94)


def _title(result: Result) -> str:
    """Verdict, kind and score; nothing where nobody judged."""
    if "verdict" not in result.statistics:
        return ""
    kind = result.mirror.kind if result.mirror is not None else "no mirror"
    return f"{result.verdict}: {kind}, score {result.score:.2f}"


def _pyvista():
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("pictures need PyVista: pip install 'symsurf[plot]'") from error
    return pyvista


def _object(
    result: Result, shape: Shape | None, points: ArrayLike | None
) -> tuple[pyvista.PolyData, NDArray[np.float64]]:
    """What is drawn, and each of its points' residual; points that are not finite cannot be."""
    if shape is None:
        chosen = result.points if points is None else points
        if chosen is None:
            raise InvalidInput("the result does not know its points: give shape or points")
        faces = result.faces if points is None else None
        shape = Shape(np.asarray(chosen, dtype=float), faces)
    residuals = _residuals(result, len(shape.points))
    finite = np.all(np.isfinite(shape.points), axis=1)
    if not finite.any():
        raise InvalidInput(f"none of the {len(finite)} points is finite")
    kept, faces = shape.points[finite], shape.faces
    if faces is None or not len(faces):
        return _pyvista().PolyData(kept), residuals[finite]
    faces = (np.cumsum(finite) - 1)[faces[finite[faces].all(axis=1)]]
    return _pyvista().PolyData.from_regular_faces(kept, faces), residuals[finite]


def _without_outliers(result: Result, object_: pyvista.PolyData) -> pyvista.PolyData:
    """What a picture should show: the object, or its points without those that lie far off."""
    outliers = result.statistics.get("outliers", 0)
    if not outliers:
        return object_
    points = np.asarray(object_.points)
    distances = np.linalg.norm(points - np.median(points, axis=0), axis=1)
    return _pyvista().PolyData(points[np.argsort(distances, kind="stable")[:-outliers]])


def _residuals(result: Result, count: int) -> NDArray[np.float64]:
    """Of each point; NaN where it has no partner."""
    if len(result.pairs) and result.pairs.max() >= count:
        raise InvalidInput(f"the result has pairs beyond the {count} points given")
    residuals = np.full(count, np.nan)
    residuals[result.pairs[:, 0]] = result.residuals
    return residuals


def _draw_object(
    plotter: pyvista.Plotter,
    object_: pyvista.PolyData,
    percent: NDArray[np.float64],
    residual_range: float | None,
    smooth: bool,
) -> None:
    paired = percent[np.isfinite(percent)]
    if residual_range is None:
        # An exact mirror's residuals are rounding; do not stretch the colours over that.
        residual_range = max(0.1, float(np.percentile(paired, 98)) if len(paired) else 0.1)
    title = "residual, % of the diagonal"
    object_[title] = percent
    bare = object_.n_cells == object_.n_verts
    style = (
        {"style": "points", "point_size": _point_size(object_), "render_points_as_spheres": True}
        if bare
        else {"smooth_shading": smooth, "split_sharp_edges": False}
    )
    plotter.add_mesh(
        object_,
        scalars=title,
        cmap=_colour_map(),
        clim=(0, residual_range),
        nan_color=UNPAIRED,
        ambient=0.25,
        specular=0.1,
        scalar_bar_args={
            "title": title,
            "color": INK,
            "fmt": "%.2g",
            "n_labels": 2,
            "width": 0.4,
            "height": 0.06,
            "position_x": 0.3,
            "position_y": 0.02,
            "title_font_size": 20,
            "label_font_size": 18,
        },
        **style,
    )


def _colour_map():
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("residual", COLOURS)


def _point_size(object_: pyvista.PolyData) -> float:
    """So that neighbouring points nearly touch, whatever their number."""
    return float(np.clip(700 / np.sqrt(object_.n_points), 3, 16))


def _draw_mirror(
    plotter: pyvista.Plotter, result: Result, object_: pyvista.PolyData
) -> NDArray[np.float64]:
    """Gives the points of what it has drawn."""
    vertices, triangles = mirror_mesh(result, object_.points)
    if not len(triangles):
        return np.empty((0, 3))
    surface = _pyvista().PolyData.from_regular_faces(vertices, triangles)
    plotter.add_mesh(surface, color=MIRROR, opacity=0.22, lighting=False)
    edges = surface.extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    if edges.n_points:
        plotter.add_mesh(edges, color=MIRROR, line_width=2)
    return vertices


def _look(
    plotter: pyvista.Plotter,
    direction: NDArray[np.float64],
    up: NDArray[np.float64],
    points: NDArray[np.float64],
    top: float,
) -> None:
    """From that direction, so close that the points fill the picture above the bar, up to that
    share of the way to its upper edge."""
    sides, bottom = 0.94, 0.7  # of the way to the picture's edges
    x0, y0, x1, y1 = plotter.renderer.viewport
    width, height = plotter.window_size
    aspect = width * (x1 - x0) / (height * (y1 - y0))
    across = np.cross(up, direction)
    across /= np.linalg.norm(across)
    axes = np.array([across, np.cross(direction, across), direction])
    distance = 2.3 * np.linalg.norm(np.ptp(points, axis=0))
    eye = (points.min(axis=0) + points.max(axis=0)) / 2 + distance * direction
    for _ in range(4):  # moved aside, it sees what is near move further than what is far
        left, low, right, high = _slopes(points, eye, axes)
        half = max((high - low) / (top + bottom), (right - left) / (2 * sides * aspect))
        aside = (left + right) / 2, (low + high) / 2 - half * (top - bottom) / 2
        eye += distance * (np.array(aside) @ axes[:2])
    left, low, right, high = _slopes(points, eye, axes)
    half = max(high / top, -low / bottom, right / (sides * aspect), -left / (sides * aspect))
    camera = plotter.camera
    camera.position, camera.focal_point, camera.up = eye, eye - distance * direction, up
    camera.view_angle = 2 * np.degrees(np.arctan(half))
    plotter.reset_camera_clipping_range()


def _slopes(
    points: NDArray[np.float64], eye: NDArray[np.float64], axes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """How far aside of the line of sight points are seen: left, lowest, right, highest."""
    x, y, z = axes @ (points - eye).T
    aside = np.array([x, y]) / -z
    return np.concatenate([aside.min(axis=1), aside.max(axis=1)])


def _view(
    result: Result, object_: pyvista.PolyData
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where to look from, and what is up: from three quarters above the higher end of the object's
    longest direction within the mirror, upright along the coordinate axis nearest to that."""
    points = np.asarray(object_.points, dtype=float)
    centre = points.mean(axis=0)
    points = points[:: max(1, len(points) // 5000)]
    chords = _chords(result, points)
    points = points - centre
    axes = np.linalg.svd(points, full_matrices=False)[2]
    # The direction the mirror maps along, on the whole.
    across = np.linalg.svd(chords, full_matrices=False)[2][0] if len(chords) else axes[2]
    along, other = (axes[i] - across * (axes[i] @ across) for i in (0, 1))
    if np.linalg.norm(along) < np.linalg.norm(other) / 2:
        along = other
    along /= np.linalg.norm(along)
    up = np.cross(across, along)
    up *= np.sign(up[np.abs(up).argmax()])
    heads = (points @ along) @ (points @ up)
    towards = 0.7 * along * (1 if heads >= 0 else -1) + 0.7 * across + 0.4 * up
    return towards / np.linalg.norm(towards), up


def _chords(result: Result, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the feet to the points that have one."""
    if result.mirror is None:
        return np.empty((0, 3))
    chords = points - result.mirror.project(points)
    return chords[np.isfinite(chords).all(axis=1)]
