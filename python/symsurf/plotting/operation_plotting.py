"""Pictures of what operations give, with PyVista."""

from __future__ import annotations

import os
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, Mirror
from ..results import (
    Alignment,
    Asymmetry,
    Completed,
    Correspondences,
    Half,
    Illuminated,
    OperationResult,
    Remeshed,
    Straightened,
    Symmetrized,
    Transferred,
    outputs,
)
from ..results.summary import of_the_diagonal, percent
from ..shapes import Shape
from .drawing import (
    COLOURS,
    INK,
    OBJECT,
    add_title,
    colour_map,
    draw_axis,
    draw_mirror,
    draw_scalars,
    finite_object,
    import_pyvista,
    place_camera,
    prepare,
    range_of,
    require_positive,
    show_or_write,
    style_of,
)

if TYPE_CHECKING:
    import pyvista

# The colours of Completed.origin.
ORIGINS = {"original": OBJECT, "mirrored": "#de8350", "seam": "#74204f"}
# From blue over light to red: what lies too far out, and what lies too far in.
DIVERGING = ("#2f5fb0", "#8fb4dc", "#f5efe4", "#e39a7b", "#a83244")
# From dark to bright.
LIGHT = ("#1b1b22", "#8a5a20", "#f0b429", "#fffbe6")
ABOVE_AXES = (1, -1.2, 0.6)
AXES = {"x": "#c8443c", "y": "#4a9c4a", "z": "#3a62c4"}


@outputs.plot.register(OperationResult)
def plot(
    result: OperationResult,
    path: str | os.PathLike[str] | None = None,
    *,
    clim: float | None = None,
    camera: Any = None,
    score: bool = True,
) -> pyvista.Plotter:
    """Draws what an operation gives; see ``OperationResult.plot``."""
    require_positive(clim)
    return show_or_write(
        path,
        lambda plotter: draw(plotter, result, clim=clim, camera=camera, score=score),
        shape=(1, 2 if isinstance(result, Straightened) or _is_homologous(result) else 1),
        border=False,
    )


def draw(
    plotter: pyvista.Plotter,
    result: OperationResult,
    *,
    clim: float | None = None,
    camera: Any = None,
    score: bool = True,
) -> None:
    """Adds an operation's result to a plotter and looks at it; arguments as for ``plot``. What is
    straightened takes two panels: before and after. Homologous asymmetry may have a second one, for its
    part along the surface."""
    title = _title(result) if score else ""
    if isinstance(result, Straightened):
        flat: Mirror = result.plane
        before, after = (
            (flat, result.mirror) if result.parameters["back"] else (result.mirror, flat)
        )
        for column, (shape, mirror) in enumerate(((result.given, before), (result.shape, after))):
            plotter.subplot(0, column)
            _draw_panel(plotter, result, shape, mirror, title if column else "", clim, camera)
        return
    _draw_panel(plotter, result, result.shape, result.mirror, title, clim, camera)
    if _is_homologous(result) and plotter.shape == (1, 2):
        plotter.subplot(0, 1)
        _draw_panel(plotter, result, result.shape, result.mirror, "", clim, camera, along=True)


def _is_homologous(result: OperationResult) -> bool:
    return isinstance(result, Asymmetry) and result.vector_sd is not None


def _draw_panel(
    plotter: pyvista.Plotter,
    result: OperationResult,
    shape: Shape,
    mirror: Mirror | None,
    title: str,
    clim: float | None,
    camera: Any,
    along: bool = False,
) -> None:
    prepare(plotter)
    object_, rows = finite_object(shape)
    if along:
        _draw_along_surface(plotter, result, object_, rows, clim)
    else:
        _draw_object(plotter, result, object_, rows, clim)
    if mirror is None:
        vertices = _drawn_axis(plotter, result, object_)
    else:
        vertices, triangles = _mirror_mesh(result, mirror, object_)
    if mirror is not None and not (isinstance(result, Half) and result.cap.any()):
        # Which would lie within the cap.
        draw_mirror(plotter, vertices, triangles)
    add_title(plotter, title)
    points = np.asarray(object_.points)
    drawn = np.vstack([points, vertices])
    if isinstance(result, Alignment):
        length = 1.3 * float(np.abs(points).max())
        _draw_axes(plotter, length)
        drawn = np.vstack([drawn, 1.1 * length * np.eye(3)])
        camera = ABOVE_AXES if camera is None else camera
    has_bar = not isinstance(result, (Alignment, Straightened))
    place_camera(plotter, camera, mirror, points, drawn, title, has_bar)


def _draw_object(
    plotter: pyvista.Plotter,
    result: OperationResult,
    object_: pyvista.PolyData,
    rows: NDArray[np.int64],
    clim: float | None,
) -> None:
    """The object in the colours of what the operation says; rows: its points' in the shape."""
    in_percent = 100 / object_.length
    if isinstance(result, Asymmetry):
        values = in_percent * result.signed[rows]
        end = clim or range_of(values)
        title = "signed asymmetry, % of the diagonal"
        draw_scalars(plotter, object_, values, title, (-end, end), colour_map(DIVERGING))
    elif isinstance(result, Correspondences):
        values = np.where(result.index < 0, np.nan, result.confidence)[rows]
        end = clim or 1.0
        draw_scalars(plotter, object_, values, "confidence", (0, end), colour_map(COLOURS[::-1]))
        _draw_pairs(plotter, result)
    elif isinstance(result, Symmetrized):
        before = result.carried(result.given.points)  # of an image, what it is the image of
        if result.is_other:
            negative = result.mirror.signed_distance(result.shape.points) < 0
            before[negative] = result.mirror.reflect(before[negative])
        moved = np.linalg.norm(result.shape.points - before, axis=1)
        values = in_percent * np.where(result.paired, moved, np.nan)[rows]
        end = clim or range_of(values)
        title = "moved by, % of the diagonal"
        draw_scalars(plotter, object_, values, title, (0, end), colour_map(COLOURS))
    elif isinstance(result, Completed):
        image = "turned" if result.mirror is None else "mirrored"
        _draw_origins(plotter, object_, result.origin[rows], image)
    elif isinstance(result, Illuminated):
        values = result.irradiance[rows]
        end = clim or float(np.percentile([0, *values[np.isfinite(values)]], 98)) or 1.0
        draw_scalars(plotter, object_, values, "irradiance", (0, end), colour_map(LIGHT))
    elif isinstance(result, Remeshed):
        plotter.add_mesh(object_, color=OBJECT, show_edges=True, edge_color=INK)
    elif isinstance(result, Half) and result.cap.any():
        _draw_parts(plotter, object_, {"surface": ~result.cap, "cap": result.cap})
    elif isinstance(result, Transferred) and np.ndim(result.values) == 1:
        values = np.asarray(result.values, float)[rows]
        ends = (clim and (0, clim)) or (float(np.nanmin(values)), float(np.nanmax(values)))
        draw_scalars(plotter, object_, values, "values", ends, colour_map(COLOURS))
    else:
        plotter.add_mesh(object_, color=OBJECT, **style_of(object_))


def _draw_along_surface(
    plotter: pyvista.Plotter,
    result: Any,
    object_: pyvista.PolyData,
    rows: NDArray[np.int64],
    clim: float | None,
) -> None:
    """The object in the colours of its asymmetry along the surface: grey below two deviations, where
    it may be none."""
    is_sure = result.tangential >= 2 * result.vector_sd
    values = 100 / object_.length * np.where(is_sure, result.tangential, np.nan)[rows]
    end = clim or range_of(values)
    title = "along the surface, % of the diagonal"
    draw_scalars(plotter, object_, values, title, (0, end), colour_map(COLOURS))


def _draw_pairs(plotter: pyvista.Plotter, result: Correspondences) -> None:
    """Some of the points that mirror each other, two of each colour."""
    seen = 50
    points = result.shape.points
    pairs = np.column_stack([np.arange(len(points)), result.index])
    pairs = pairs[(result.index > pairs[:, 0]) & np.isfinite(points).all(axis=1)]
    if not len(pairs) or result.mirror is None:  # of two shapes: the others are not here
        return
    chosen = pairs[:: max(1, len(pairs) // seen)]
    plotter.add_mesh(
        import_pyvista().PolyData(points[chosen.T.ravel()]),
        scalars=np.tile(np.arange(len(chosen)) % 7, 2),
        cmap="tab10",
        clim=(0, 9),
        show_scalar_bar=False,
        render_points_as_spheres=True,
        point_size=22,
    )


def _draw_origins(
    plotter: pyvista.Plotter, object_: pyvista.PolyData, origin: NDArray[np.int64], image: str
) -> None:
    """Faces of the seam join original points with others. image: what those of 1 are called."""
    of_cells = origin
    if object_.n_cells != object_.n_verts:
        corners = origin[object_.regular_faces]
        of_cells = np.where(corners.min(axis=1) > 0, 1, 2 * (corners.max(axis=1) > 0))
    names = [image if name == "mirrored" else name for name in ORIGINS]
    _draw_parts(plotter, object_, {name: of_cells == k for k, name in enumerate(names)})


def _draw_parts(
    plotter: pyvista.Plotter, object_: pyvista.PolyData, parts: dict[str, NDArray[np.bool_]]
) -> None:
    """Each part, chosen among the cells, in a colour of its own."""
    colours = dict(zip(parts, ORIGINS.values(), strict=False))
    shown = {name: chosen for name, chosen in parts.items() if chosen.any()}
    for k, (name, chosen) in enumerate(shown.items()):
        part = object_.extract_cells(np.flatnonzero(chosen)).extract_surface(algorithm=None)
        part[name] = np.zeros(part.n_points)
        # A bar of one colour: the entries of a legend have its colour, which is too light to read.
        bar = {"title": name, "color": INK, "n_labels": 0, "title_font_size": 20}
        place = {"width": 0.18, "height": 0.06, "position_y": 0.02}
        left = {"position_x": 0.51 + 0.2 * (k - len(shown) / 2)}
        plotter.add_mesh(
            part,
            scalars=name,
            cmap=[colours[name]],
            clim=(0, 1),
            scalar_bar_args=bar | place | left,
            **style_of(part),
        )


def _draw_axes(plotter: pyvista.Plotter, length: float) -> None:
    """Arrows from the origin with the axes' names."""
    for direction, colour in zip(np.eye(3), AXES.values(), strict=True):
        arrow = import_pyvista().Arrow(
            direction=direction,
            scale=length,
            shaft_radius=0.01,
            tip_radius=0.03,
            tip_length=0.1,
        )
        plotter.add_mesh(arrow, color=colour, ambient=0.6)
    plotter.add_point_labels(
        1.05 * length * np.eye(3),
        list(AXES),
        text_color=INK,
        shape=None,
        show_points=False,
        always_visible=True,
        font_size=22,
    )


def _drawn_axis(
    plotter: pyvista.Plotter, result: OperationResult, object_: pyvista.PolyData
) -> NDArray[np.float64]:
    """Draws the axis of what is completed about one; its ends."""
    axis = result.axis if isinstance(result, Completed) else None
    if axis is None:
        return np.empty((0, 3))
    draw_axis(plotter, axis, object_)
    return axis.ends


def _mirror_mesh(
    result: OperationResult, mirror: Mirror, object_: pyvista.PolyData
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and triangles over the object; none where the mirror maps none of it."""
    with suppress(InvalidInput):
        if isinstance(result, Illuminated) and mirror.footprint is not None:
            return mirror.mesh()
        if not isinstance(result, Alignment):
            return mirror.mesh(object_.points)
        vertices, triangles = mirror.mesh(result.given.points)
        return vertices @ result.matrix[:3, :3].T + result.matrix[:3, 3], triangles
    return np.empty((0, 3)), np.empty((0, 3), np.int64)


def _title(result: OperationResult) -> str:
    figures = result.statistics
    kind = result.mirror.kind if result.mirror is not None else "axis"
    if isinstance(result, Asymmetry):
        matched = percent(figures["matched_share"])
        if "rms_of_diagonal" not in figures:
            return f"asymmetry over a {kind}: {matched} matched"
        rms = of_the_diagonal(figures["rms_of_diagonal"])
        return f"asymmetry over a {kind}: rms {rms}, {matched} matched"
    if isinstance(result, (Correspondences, Symmetrized)):
        name = "symmetrized" if isinstance(result, Symmetrized) else "correspondences"
        return f"{name} over a {kind}: {percent(figures['paired_share'])} paired"
    if isinstance(result, Completed):
        added = len(result.shape.points) - len(result.given.points)
        over = f"over a {kind}" if result.mirror is not None else "about an axis"
        return f"completed {over}: {added} points added"
    if isinstance(result, Remeshed):
        length = of_the_diagonal(figures["edge_length_of_diagonal"])
        return f"remeshed over a {kind}: edges of {length}"
    if isinstance(result, Half):
        return f"cut along a {kind}: {figures['cap_faces']} faces close it"
    if isinstance(result, Illuminated):
        return f"illuminated over a {kind}: {percent(figures['lit_share'])} lit"
    if isinstance(result, Transferred):
        return f"transferred over a {kind}: {figures['failed_points']} points have no counterpart"
    if isinstance(result, Straightened):
        return f"{'bent back' if result.parameters['back'] else 'straightened'} over a {kind}"
    return f"aligned by a {kind}"
