"""The page of one shape: in 3D with its mirror, coloured by its asymmetry, and in figures."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from datetime import datetime, timezone
from importlib.metadata import version
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import __version__
from ..base.plain import shown
from ..plotting.drawing import finite_object, new_plotter
from ..plotting.operation_plotting import draw
from ..results import Asymmetry
from ..results.summary import figures, fixed, of_the_diagonal, percent, value_text
from .charts import histogram
from .html import columns, framed, heading, page, paragraph, pictures, signature, table
from .scene import scripts_of, viewer_page

Record = Mapping[str, Any]


def shape_page(record: Record, asymmetry: Asymmetry) -> bytes:
    """The page of a file; with tolerance bands an inspection report to print and to sign.

    Args:
        record: what was reported of it.
        asymmetry: that of the shape in the file.
    """
    plotter = new_plotter(off_screen=True)
    draw(plotter, asymmetry, score=False)
    scene = viewer_page(plotter)
    plotter.close()
    diagonal = asymmetry.statistics["diagonal"]
    signed = asymmetry.signed[np.isfinite(asymmetry.signed)]
    percent = 100 * signed / diagonal
    kind = asymmetry.mirror.kind
    name = Path(record["file"]).name
    is_inspection = bool(record.get("bands"))
    return page(
        name,
        [
            *(
                [paragraph(f"Verdict {record['verdict']}: {record['reason']}.")]
                if record["verdict"] is not None
                else []
            ),
            paragraph(_sentence(record, kind)),
            *(_about(record) if is_inspection else []),
            framed(scene, f"{name} in 3D"),
            paragraph("Drag to turn, roll the wheel to zoom.", "screen"),
            *(_sides(asymmetry) if is_inspection else []),
            paragraph(
                "Blue: further out than the mirrored other side; red: further in; grey: no counterpart."
            ),
            *([_bands_and_patches(record)] if is_inspection else []),
            columns(
                heading("Signed asymmetry")
                + histogram(percent, "% of the diagonal", "points", symmetric=True),
                heading("Mirror") + table(_mirror_rows(record), numbers=False),
            ),
            columns(
                heading("Asymmetry")
                + table(
                    _statistics_rows(record),
                    ("", record["unit"] or "input units", "% of the diagonal"),
                ),
                heading("Parameters") + table(_parameter_rows(record), numbers=False),
            ),
            *([signature("Date", "Name", "Signature")] if is_inspection else []),
        ],
        scripts_of(scene),
    )


def _about(record: Record) -> list[str]:
    """What an inspection report begins with."""
    value = f"{record['statistics']['symmetry_value']:.4g} {record['unit'] or 'input units'}"
    rows = [
        ("part", Path(record["file"]).name),
        ("date", datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC")),
        ("symmetry value", value),
        ("settings", record["settings"]),
        (
            "versions",
            f"symsurf {__version__}, PyVista {version('pyvista')}, NumPy {np.__version__}",
        ),
    ]
    return [table(rows, numbers=False)]


_SIDE = (720, 540)
_NUMBERED = 20


def _sides(asymmetry: Asymmetry) -> list[str]:
    """Six pictures, as the scene is not printed, with the numbers of the patches in view."""
    return [
        heading("Six sides"),
        pictures(
            (f"from {'+' if way > 0 else '-'}{axis}", _side(asymmetry, way * direction))
            for axis, direction in zip("xyz", np.eye(3))
            for way in (1, -1)
        ),
    ]


def _side(asymmetry: Asymmetry, direction: NDArray[np.float64]) -> bytes:
    plotter = new_plotter(off_screen=True, window_size=_SIDE)
    draw(plotter, asymmetry, score=False, camera=direction)
    surface = finite_object(asymmetry.shape)[0]
    far = direction * surface.length
    in_view = {
        str(number): patch.place
        for number, patch in enumerate(asymmetry.patches[:_NUMBERED], 1)
        if asymmetry.shape.faces is None
        or not len(surface.ray_trace(patch.place + 1e-3 * far, patch.place + 2 * far)[0])
    }
    if in_view:
        plotter.add_point_labels(
            np.array([*in_view.values()]),
            [*in_view],
            font_size=36,
            shape_color="white",
            always_visible=True,
        )
    picture = BytesIO()
    plotter.screenshot(picture)
    plotter.close()
    return picture.getvalue()


def _bands_and_patches(record: Record) -> str:
    unit = record["unit"] or "input units"
    bands = [(f"{band['limit']:g}", percent(band["share"])) for band in record["bands"]]
    patches = [
        (
            str(number),
            f"{patch['largest']:.4g}",
            "" if patch["area"] is None else f"{patch['area']:.4g}",
            "  ".join(f"{x:.4g}" for x in patch["place"]),
        )
        for number, patch in enumerate(record["patches"], 1)
    ]
    names = ("", f"largest deviation, {unit}", "area", "place")
    return columns(
        heading("Tolerance bands") + table(bands, (f"within, {unit}", "share of the area")),
        heading("Patches") + table(patches, names),
    )


def _sentence(record: Record, kind: str) -> str:
    statistics = record["statistics"]
    matched = f"{percent(statistics['matched_share'])} of {record['points']} points"
    rms = of_the_diagonal(statistics["rms_of_diagonal"])
    source = "that was given" if record["score"] is None else f"with score {record['score']:.2f}"
    return f"Over a {kind} {source}, {matched} have a counterpart; they lie {rms} from it (root mean square)."


def _mirror_rows(record: Record) -> list[tuple[str, str]]:
    mirror: dict[str, Any] = record["mirror"]
    rows = []
    if record["score"] is not None:
        rows = [("method", record["method"]), ("score", fixed(record["score"], 2))]
    return rows + [(name, _spaced(value)) for name, value in mirror.items()]


def _statistics_rows(record: Record) -> list[tuple[str, str, str]]:
    diagonal = record["statistics"]["diagonal"]
    digits = max(0, 4 - math.floor(math.log10(diagonal))) if diagonal > 0 else 0
    return [
        (_title(name), value_text(name, value), "")
        if share is None
        else (_title(name), fixed(value, digits), fixed(100 * share, 3))
        for name, value, share in figures(record["statistics"])
    ]


def _parameter_rows(record: Record) -> list[tuple[str, str]]:
    return [
        (name.replace("_", " "), _spaced(value)) for name, value in record["parameters"].items()
    ]


def _title(name: str) -> str:
    """Of a statistic, in words: "95th percentile" of p95."""
    return re.sub(r"^p(\d\d)$", r"\1th percentile", name).replace("_", " ")


def _spaced(value: Any) -> str:
    return shown(value).replace(",", ", ")
