"""The page of a cohort: its ANOVA, where the asymmetry lies, and its individuals."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.lengths import diagonal_of
from ..morphometrics import Cohort, plane_of_landmarks
from ..plotting.drawing import (
    COLOURS,
    colour_map,
    draw_scalars,
    new_plotter,
    place_camera,
    prepare,
    range_of,
)
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
_COLOURED = 90  # percentile: what is drawn light, nine of ten faces have
_HIGH = 95  # percentile: the usual end of a reference range of one tail
_MOST_ROWS = 100  # of a table of landmarks; more are drawn, of clouds without faces
_UNIT = "Lengths are in the unit of the files, at the mean centroid size: half of what the sides differ by."


def cohort_page(
    title: str,
    cohort: Cohort,
    individuals: Sequence[Mapping[str, Any]],
    compared: int,
    source: str,
    names: Sequence[str] = (),
    faces: NDArray[np.int64] | None = None,
) -> bytes:
    """The page.

    Args:
        individuals: a row each, with its name in "individual"; of them "asymmetry" is drawn.
        compared: the one that is compared with the others, by its row.
        source: what told the pairs.
        names: of the landmarks.
        faces: (m, 3) of meshes.
    """
    count = len(cohort.mean)
    is_drawn = cohort.mean.shape[1] == 3 and (faces is not None or count > _MOST_ROWS)
    scenes = _scenes(cohort, compared, faces) if is_drawn else []
    name = individuals[compared]["individual"]
    parts = [
        paragraph(
            f"{len(individuals)} individuals, {cohort.size.shape[1]} replicates, {count} landmarks, "
            f"{len(cohort.midline)} of them on the midline, by {source}."
        ),
        heading("Procrustes ANOVA"),
        table(_anova_rows(cohort), ("", "SS", "df", "MS", "F", "p")),
        *(
            _maps(scenes, cohort, compared, name)
            if scenes
            else _table(cohort, compared, name, names)
        ),
        heading("Individuals"),
        paragraph("Sizes are in the unit of the files, lengths shares of the centroid size."),
        histogram(
            np.array([row["asymmetry"] for row in individuals]),
            "length of the asymmetry",
            "individuals",
            symmetric=False,
        ),
        table(_individual_rows(individuals), [*individuals[0], "rank by asymmetry"]),
    ]
    return page(title, parts, dict.fromkeys(each for scene in scenes for each in scripts_of(scene)))


def _maps(scenes: Sequence[str], cohort: Cohort, compared: int, name: str) -> list[str]:
    headings = (
        "Mean asymmetry: directional",
        "Standard deviation of the asymmetry: fluctuating",
        f"{name} against the others",
    )
    texts = (_UNIT, _UNIT, _comparison(cohort, compared, name))
    return [
        part
        for head, text, scene in zip(headings, texts, scenes, strict=True)
        for part in (heading(head), paragraph(text), framed(scene, head))
    ]


def _table(cohort: Cohort, compared: int, name: str, names: Sequence[str]) -> list[str]:
    own = cohort.size.mean() * cohort.magnitude[compared]
    values = (*_lengths(cohort), own, cohort.percentile(compared))
    rows = [
        [label, *(_shown(float(value)) for value in row)]
        for label, *row in zip(names or map(str, range(len(own))), *values, strict=True)
    ]
    return [
        heading(f"Landmarks, and {name} against the others"),
        paragraph(_UNIT),
        paragraph(_comparison(cohort, compared, name)),
        table(rows, ("", "mean asymmetry", "standard deviation", name, "percentile")),
    ]


def _comparison(cohort: Cohort, compared: int, name: str) -> str:
    share = 100 * (cohort.percentile(compared) > _HIGH).mean()
    return (
        f"Percentile of the asymmetry of {name} among the others: above {_HIGH} at {share:.3g} % of "
        "the landmarks."
    )


def _lengths(cohort: Cohort) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(k,) of the mean asymmetry, and of its standard deviation, in input units."""
    size = cohort.size.mean()
    return size * np.linalg.norm(cohort.directional, axis=1), size * cohort.deviation


def _scenes(cohort: Cohort, compared: int, faces: NDArray[np.int64] | None) -> list[str]:
    """The viewer's pages: mean and deviation on the mean shape, percentiles on the individual."""
    size = cohort.size.mean()
    mirror = plane_of_landmarks(cohort.mean, cohort.pairs, cohort.midline)
    mean = Shape(size * cohort.mean, faces)
    own = Shape(size * (cohort.symmetric[compared] + cohort.asymmetric[compared]), faces)
    share = diagonal_of(mean.points) / 100
    maps = [
        (mean, values, "asymmetry", (0, share * range_of(values / share)))
        for values in _lengths(cohort)
    ]
    maps.append((own, cohort.percentile(compared), "percentile", (_COLOURED, 100)))
    scenes = []
    for shape, values, title, clim in maps:
        plotter = new_plotter(off_screen=True)
        prepare(plotter)
        draw_scalars(plotter, shape.to_pyvista(), values, title, clim, colour_map(COLOURS))
        place_camera(plotter, None, mirror, shape.points, shape.points, "")
        scenes.append(viewer_page(plotter))
        plotter.close()
    return scenes


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
