"""What pictures of results and of operations are made of, with PyVista."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from io import BytesIO
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, InvalidParameter, Mirror
from ..base.optional import require
from ..results import Axis
from ..saving import write_whole
from ..shapes import Shape

if TYPE_CHECKING:
    import pyvista

SIZE = (1200, 900)
_BAR = np.array([480, 54])  # pixels, as the sizes of its letters are
UNPAIRED = "#9aa3ad"
MIRROR = "#2f7fd0"
AXIS = "#a83244"
OBJECT = "#efdcb8"
BACKGROUND = "#ffffff"
INK = "#333333"
# From light to dark in even steps: an exact mirror leaves the object light.
COLOURS = ("#f5e6c8", "#f0bd80", "#de8350", "#b4464b", "#74204f")


def show_or_write(
    path: str | os.PathLike[str] | None,
    draw_into: Callable[[pyvista.Plotter], None],
    **options: Any,
) -> pyvista.Plotter:
    """What it draws into a plotter with these options, in a window, or as a PNG off-screen."""
    if path is not None and Path(path).suffix.lower() != ".png":
        raise InvalidParameter(f"path is {str(path)!r}; allowed is the suffix .png")
    plotter = new_plotter(off_screen=path is not None, **options)
    draw_into(plotter)
    if path is None:
        plotter.show(auto_close=False)
    else:
        write_picture(plotter, Path(path))
    return plotter


def require_positive(clim: float | None) -> None:
    """Raises InvalidParameter for another end of the colours."""
    if clim is not None and not (isinstance(clim, Real) and 0 < float(clim) < np.inf):
        raise InvalidParameter(f"clim is {clim!r}; allowed is a number in (0, inf)")


def write_picture(plotter: pyvista.Plotter, path: Path) -> None:
    """As a PNG, whole or not at all; closes the plotter."""
    picture = BytesIO()
    plotter.screenshot(picture)
    plotter.close()
    write_whole(path, picture.getvalue())


def new_plotter(off_screen: bool, **options: Any) -> pyvista.Plotter:
    """A plotter of our size, without a window where off_screen."""
    if off_screen and sys.platform == "linux" and not os.environ.get("DISPLAY"):
        from ctypes.util import find_library  # `import symsurf` does not wait for it

        # VTK would try X first, and complain.
        if find_library("EGL"):
            os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    return import_pyvista().Plotter(off_screen=off_screen, **{"window_size": SIZE} | options)


def prepare(plotter: pyvista.Plotter) -> None:
    """Background and light."""
    plotter.set_background(BACKGROUND)
    plotter.enable_anti_aliasing("ssaa")
    plotter.enable_lightkit()


def add_title(plotter: pyvista.Plotter, title: str) -> None:
    if title:
        plotter.add_text(title, position="upper_edge", font_size=12, color=INK)


def import_pyvista() -> Any:
    return require("pictures", "pyvista")


def finite_object(shape: Shape) -> tuple[pyvista.PolyData, NDArray[np.int64]]:
    """A shape without the points that are not finite, which cannot be drawn, and their faces; and
    which points these are."""
    finite = np.all(np.isfinite(shape.points), axis=1)
    if not finite.any():
        raise InvalidInput(f"none of the {len(finite)} points is finite")
    faces = shape.faces
    if faces is not None:
        faces = (np.cumsum(finite) - 1)[faces[finite[faces].all(axis=1)]]
    rows = np.flatnonzero(finite)
    return Shape(np.asarray(shape.points)[rows], faces).to_pyvista(), rows


def colour_map(colours: Sequence[str]) -> Any:
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("symsurf", colours)


def range_of(percent: NDArray[np.float64]) -> float:
    """What 98 % of the finite values stay below. What is exact differs by rounding: colours are not
    stretched over less than 0.1."""
    finite = np.abs(percent[np.isfinite(percent)])
    return max(0.1, float(np.percentile(finite, 98))) if len(finite) else 0.1


def draw_scalars(
    plotter: pyvista.Plotter,
    object_: pyvista.PolyData,
    values: NDArray[np.float64],
    title: str,
    clim: tuple[float, float],
    colours: Any,
    smooth: bool = True,
) -> None:
    """Adds a mesh or a cloud coloured by values of its points, grey where they are NaN, and the bar
    of colours with its title."""
    object_[title] = values
    width, height = np.minimum(_BAR / _pixels(plotter), 0.9)
    plotter.add_mesh(
        object_,
        scalars=title,
        cmap=colours,
        clim=clim,
        nan_color=UNPAIRED,
        scalar_bar_args={
            "title": title,
            "color": INK,
            "fmt": "%.2g" if clim[1] < 99.5 else "%.0f",  # 100, not 1e+02
            "n_labels": 2,
            "width": width,
            "height": height,
            "position_x": (1 - width) / 2,
            "position_y": 0.02,
            "title_font_size": 20,
            "label_font_size": 18,
        },
        **style_of(object_, smooth),
    )


def style_of(object_: pyvista.PolyData, smooth: bool = True) -> dict[str, Any]:
    """How a mesh is shaded, or the points of a cloud are drawn."""
    light = {"ambient": 0.25, "specular": 0.1}
    if object_.n_cells == object_.n_verts:
        size = _point_size(object_)
        points = {"style": "points", "point_size": size, "render_points_as_spheres": True}
        return light | points
    return light | {"smooth_shading": smooth, "split_sharp_edges": False}


def _point_size(object_: pyvista.PolyData) -> float:
    """So that neighbouring points nearly touch, whatever their number."""
    return float(np.clip(700 / np.sqrt(object_.n_points), 3, 16))


def draw_mirror(
    plotter: pyvista.Plotter, vertices: NDArray[np.float64], triangles: NDArray[np.int64]
) -> None:
    """Adds a mirror's triangles, translucent, with their rim; nothing of none."""
    if not len(triangles):
        return
    surface = import_pyvista().PolyData.from_regular_faces(vertices, triangles)
    plotter.add_mesh(surface, color=MIRROR, opacity=0.22, lighting=False)
    edges = surface.extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    if edges.n_points:
        plotter.add_mesh(edges, color=MIRROR, line_width=2)


def draw_axis(plotter: pyvista.Plotter, axis: Axis, object_: pyvista.PolyData) -> None:
    """Adds a rotation axis between its ends."""
    tube = import_pyvista().Line(*axis.ends).tube(radius=0.004 * object_.length)
    plotter.add_mesh(tube, color=AXIS)


def place_camera(
    plotter: pyvista.Plotter,
    camera: Any,
    mirror: Mirror | None,
    object_: NDArray[np.float64],
    drawn: NDArray[np.float64],
    title: str,
    has_bar: bool = True,
) -> None:
    """Looks at what is drawn from a direction (3,), from a camera position of PyVista, or, where the
    camera is None, as shows most of the object and its mirror.

    Raises InvalidParameter for another camera.
    """
    if camera is None:
        look(plotter, *view(mirror, object_), drawn, title, has_bar)
        return
    try:
        direction = np.asarray(camera, dtype=float)
    except (TypeError, ValueError):
        direction = np.empty(0)  # the name of a position, or one of three points
    if direction.shape == (3,) and np.isfinite(direction).all() and direction.any():
        direction = direction / np.linalg.norm(direction)
        upright = np.eye(3)[2 if abs(direction[2]) < 0.99 else 1]
        up = upright - direction * (upright @ direction)
        look(plotter, direction, up / np.linalg.norm(up), drawn, title, has_bar)
        return
    try:
        if direction.shape == (3,):
            raise ValueError("no direction")
        plotter.camera_position = camera
    except Exception as error:
        raise InvalidParameter(
            f"camera is {camera!r}; allowed is a direction of 3 numbers or a camera position of "
            "PyVista"
        ) from error


def _pixels(plotter: pyvista.Plotter) -> NDArray[np.float64]:
    """Width and height of the picture, or of its active part."""
    corners = np.reshape(plotter.renderer.viewport, (2, 2))
    return np.multiply(plotter.window_size, corners[1] - corners[0])


def look(
    plotter: pyvista.Plotter,
    direction: NDArray[np.float64],
    up: NDArray[np.float64],
    points: NDArray[np.float64],
    title: str,
    has_bar: bool,
) -> None:
    """From that direction, so close that the points fill the picture between bar and title."""
    # Of the way to the picture's edges.
    sides, bottom, top = 0.94, 0.7 if has_bar else 0.94, 0.86 if title else 0.94
    aspect = np.divide(*_pixels(plotter))
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


def view(
    mirror: Mirror | None, points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where to look from, and what is up: from three quarters above the higher end of the object's
    longest direction within the mirror, upright along the coordinate axis nearest to that."""
    points = np.asarray(points, dtype=float)
    centre = points.mean(axis=0)
    points = points[:: max(1, len(points) // 5000)]
    chords = _chords(mirror, points)
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


def _chords(mirror: Mirror | None, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the feet to the points that have one."""
    if mirror is None:
        return np.empty((0, 3))
    chords = points - mirror.project(points)
    return chords[np.isfinite(chords).all(axis=1)]
