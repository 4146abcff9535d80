"""Pictures of what analyses find, with PyVista."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidParameter, analyses
from ..results import AnalysisResult, Symmetries, outputs
from .drawing import (
    COLOURS,
    OBJECT,
    UNPAIRED,
    add_title,
    colour_map,
    draw_axis,
    draw_mirror,
    draw_scalars,
    finite_object,
    place_camera,
    prepare,
    show_or_write,
    style_of,
)

if TYPE_CHECKING:
    import pyvista

# Labels repeat them; neighbours in the list differ in lightness, too, for colour-blind readers.
LABELS = (
    "#4477aa",
    "#ee6677",
    "#228833",
    "#ccbb44",
    "#66ccee",
    "#aa3377",
    "#dd8844",
    "#775533",
)
MOST_PLANES = 16  # more hide the shape


@outputs.plot.register(AnalysisResult)
def plot(
    result: AnalysisResult,
    path: str | os.PathLike[str] | None = None,
    *,
    camera: Any = None,
    title: bool = True,
) -> pyvista.Plotter:
    """Draws what an analysis finds; see ``AnalysisResult.plot``."""
    return show_or_write(path, lambda plotter: _draw(plotter, result, camera, title))


def _draw(plotter: pyvista.Plotter, result: AnalysisResult, camera: Any, title: bool) -> None:
    prepare(plotter)
    object_, rows = finite_object(result.shape)
    has_bar = _draw_object(plotter, result, object_, rows)
    drawn = [np.asarray(object_.points)]
    for plane in result.planes[:MOST_PLANES]:
        vertices, triangles = plane.mesh()
        draw_mirror(plotter, vertices, triangles)
        drawn.append(vertices)
    for axis in result.axes:
        draw_axis(plotter, axis, object_)
        drawn.append(axis.ends)
    words = _title(result) if title else ""
    add_title(plotter, words)
    mirror = result.planes[0] if result.planes else None
    place_camera(plotter, camera, mirror, drawn[0], np.vstack(drawn), words, has_bar)


def _draw_object(
    plotter: pyvista.Plotter,
    result: AnalysisResult,
    object_: pyvista.PolyData,
    rows: NDArray[np.int64],
) -> bool:
    """The object in the colours of what the analysis says; whether there is a bar of them."""
    shown = analyses()[result.analysis].shown
    colours = result.shape.colours
    if shown not in result.arrays and colours is not None and colours.shape[1] in (3, 4):
        of_one = 1.0 if colours.max() > 1 else 255.0
        object_.point_data["colours"] = np.clip(of_one * colours[rows], 0, 255).astype(np.uint8)
        plotter.add_mesh(object_, scalars="colours", rgb=True, **style_of(object_, smooth=False))
        return False
    if shown not in result.arrays:
        plotter.add_mesh(object_, color=OBJECT, **style_of(object_, smooth=False))
        return False
    values = result.arrays[shown][rows]
    if values.ndim != 1:
        raise InvalidParameter(f"{shown} has {values.shape[1]} components; allowed is 1")
    if values.dtype.kind == "f":
        finite = values[np.isfinite(values)]
        ends = (0.0, max(float(finite.max()), 1e-9) if len(finite) else 1.0)
        draw_scalars(plotter, object_, values, shown, ends, colour_map(COLOURS))
        return True
    _draw_labels(plotter, object_, values.astype(np.int64), shown)
    return False


def _draw_labels(
    plotter: pyvista.Plotter, object_: pyvista.PolyData, labels: NDArray[np.int64], name: str
) -> None:
    """A colour a label, grey where it is negative; of a face that of its first corner, where none
    of its corners is grey."""
    from matplotlib.colors import ListedColormap

    colours = np.where(labels < 0, len(LABELS), labels % len(LABELS))
    if object_.n_cells != object_.n_verts:
        faces = object_.regular_faces
        is_grey = (labels[faces] < 0).any(axis=1)
        object_.cell_data[name] = np.where(is_grey, len(LABELS), colours[faces[:, 0]])
    else:
        object_.point_data[name] = colours
    plotter.add_mesh(
        object_,
        scalars=name,
        cmap=ListedColormap([*LABELS, UNPAIRED]),
        clim=(0, len(LABELS)),
        show_scalar_bar=False,
        **style_of(object_, smooth=False),
    )


def _title(result: AnalysisResult) -> str:
    name = result.analysis.replace("_", " ")
    if isinstance(result, Symmetries):
        name = f"symmetry group {result.group}"
    counts = ", ".join(
        f"{len(found)} {one if len(found) == 1 else many}"
        for one, many, found in (
            ("plane", "planes", result.planes),
            ("axis", "axes", result.axes),
            ("transformation", "transformations", result.transformations),
        )
        if found and not (isinstance(result, Symmetries) and one == "transformation")
    )
    return f"{name}: {counts}" if counts else name
