"""The page of a cohort: its ANOVA, its individuals and, of meshes, where the asymmetry lies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..morphometrics import Cohort
from ..plotting.drawing import new_plotter
from ..shapes import Shape
from .charts import histogram
from .html import framed, heading, page, paragraph, ranks_of, table
from .scene import scripts_of, viewer_page

_SOURCES = {
    "individual": "individuals",
    "side": "sides: directional asymmetry",
    "individual_side": "individuals x sides: fluctuating asymmetry",
    "error": "replicates: error of measurement",
}


def cohort_page(
    title: str,
    cohort: Cohort,
    individuals: Sequence[Mapping[str, Any]],
    faces: NDArray[np.int64] | None = None,
) -> bytes:
    """The page.

    Args:
        individuals: a row each, of which "asymmetry" is drawn.
        faces: (m, 3) of meshes.
    """
    lengths = np.array([row["asymmetry"] for row in individuals])
    scene = None if faces is None else _scene(cohort, faces)
    parts = [
        paragraph(
            f"{len(individuals)} individuals, {cohort.size.shape[1]} replicates, "
            f"{len(cohort.mean)} landmarks. Lengths are shares of the centroid size."
        ),
        heading("Procrustes ANOVA"),
        table(_anova_rows(cohort), ("", "SS", "df", "MS", "F", "p")),
    ]
    if scene is not None:
        parts += [
            heading("Mean shape, coloured by the mean length of the asymmetry"),
            framed(scene, "mean asymmetry in 3D"),
        ]
    parts += [
        heading("Individuals"),
        histogram(lengths, "length of the asymmetry", "individuals", symmetric=False),
        table(_individual_rows(individuals), [*individuals[0], "rank by asymmetry"]),
    ]
    return page(title, parts, () if scene is None else scripts_of(scene))


def _scene(cohort: Cohort, faces: NDArray[np.int64]) -> str:
    """The viewer's page."""
    mesh = Shape(cohort.mean, faces).to_pyvista()
    mesh["mean asymmetry"] = cohort.magnitude.mean(axis=0)
    plotter = new_plotter(off_screen=True)
    plotter.add_mesh(mesh, scalars="mean asymmetry", cmap="viridis")
    scene = viewer_page(plotter)
    plotter.close()
    return scene


def _anova_rows(cohort: Cohort) -> list[list[str]]:
    return [
        [_SOURCES[name], *(_shown(row[key]) for key in ("ss", "df", "ms", "F", "p"))]  # type: ignore[literal-required]
        for name, row in cohort.table.items()
    ]


def _individual_rows(individuals: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    ranks = ranks_of(np.array([row["asymmetry"] for row in individuals]))
    return [
        [*map(_shown, row.values()), rank] for row, rank in zip(individuals, ranks, strict=True)
    ]


def _shown(value: Any) -> str:
    if not isinstance(value, float):
        return str(value)
    return "" if math.isnan(value) else f"{value:.4g}"
