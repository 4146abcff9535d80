"""The page of many shapes: a row each, and percentiles over all of them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import quote

import numpy as np

from ..results.summary import fixed
from .charts import histogram
from .html import Html, heading, page, paragraph, ranks_of, table

PERCENTILES = (0, 5, 25, 50, 75, 95, 100)
# Of the columns of a batch: their names here, what they are multiplied by, and the digits behind
# the point. Lengths are shares of the diagonal: shapes differ in size.
_FIGURES = {
    "score": ("score", 1, 2),
    "paired_share": ("paired, %", 100, 1),
    "mean_of_diagonal": ("mean", 100, 3),
    "rms_of_diagonal": ("rms", 100, 3),
    "median_of_diagonal": ("median", 100, 3),
    "p95_of_diagonal": ("95th percentile", 100, 3),
    "maximum_of_diagonal": ("maximum", 100, 3),
    "signed_mean_of_diagonal": ("signed mean", 100, 3),
    "area_index": ("area index", 1, 3),
    "volume_index": ("volume index", 1, 3),
}
FENCE = 1.5
"""Times the distance between the quartiles: an outlier's rms lies farther above them (Tukey 1977)."""
FEWEST = 5
"""Files that have quartiles to speak of."""
_SHOWN = ("score", "paired_share", "rms_of_diagonal", "p95_of_diagonal", "maximum_of_diagonal")


def files_page(title: str, rows: Sequence[Mapping[str, Any]], links: Mapping[str, str]) -> bytes:
    """The page of a batch of asymmetries.

    Args:
        rows: of ``symsurf.batch``.
        links: the page of each file, relative to this; its picture lies beside it.
    """
    good = [row for row in rows if not row["error"]]
    doubtful = sum(row["verdict"] == "none" for row in good)
    sentence = f"{len(good) - doubtful} of {len(rows)} files have a mirror."
    if doubtful:
        sentence += f' {doubtful} more, with the verdict "none", are among the figures.'
    sentence += " Lengths of the asymmetry are in % of the diagonal of the bounding box."
    parts = [paragraph(sentence)]
    if good:
        rms = 100 * _column(good, "rms_of_diagonal")
        label = "root mean square of the asymmetry, % of the diagonal"
        parts += [
            heading("Over all files"),
            table(_percentile_rows(good), ("", *(_name(p) for p in PERCENTILES), "files")),
            histogram(rms, label, "files", symmetric=False),
        ]
        words = ("", "file", "mirror", "verdict")
        names = (*words, *(_FIGURES[name][0] for name in _SHOWN), "rank by rms")
        parts += [heading("Files"), table(_file_rows(good, links), names, texts=len(words))]
    if errors := [(Path(row["file"]).name, row["error"]) for row in rows if row["error"]]:
        parts += [heading("Files that failed"), table(errors, ("file", "reason"), numbers=False)]
    return page(title, parts)


def _percentile_rows(good: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    made = []
    for name, (title, factor, digits) in _FIGURES.items():
        values = factor * _column(good, name)
        if len(values):
            percentiles = np.percentile(values, PERCENTILES).tolist()
            made.append([title, *(fixed(value, digits) for value in percentiles), str(len(values))])
    return made


def _file_rows(good: Sequence[Mapping[str, Any]], links: Mapping[str, str]) -> list[list[str]]:
    rms = _column(good, "rms_of_diagonal")
    ranks, limit = ranks_of(rms), _outlier_limit(rms)
    made = []
    for row, rank in zip(good, ranks, strict=True):
        page = links[row["file"]]
        target, picture = (
            quote(os.fsencode(path))
            for path in (page, str(PurePosixPath(page).with_suffix(".png")))
        )
        image = (
            f'<a class="thumbnail" href="{target}"><img loading="lazy" src="{picture}" alt=""></a>'
        )
        link = f'<a href="{target}">{escape(Path(row["file"]).name)}</a>'
        if row["rms_of_diagonal"] > limit:
            rank = Html(f'<span class="outlier">{rank}, outlier</span>')
        figures = [_text(row, key) for key in _SHOWN]
        made.append([Html(image), Html(link), row["kind"], row["verdict"], *figures, rank])
    return made


def _text(row: Mapping[str, Any], key: str) -> str:
    _, factor, digits = _FIGURES[key]
    return fixed(factor * row[key], digits) if key in row else ""


def _outlier_limit(rms: np.ndarray) -> float:
    if len(rms) < FEWEST:
        return np.inf
    low, high = np.percentile(rms, (25, 75))
    return float(high + FENCE * (high - low))


def _column(rows: Sequence[Mapping[str, Any]], name: str) -> np.ndarray:
    return np.array([row[name] for row in rows if name in row], dtype=float)


def _name(percentile: int) -> str:
    return {0: "minimum", 50: "median", 100: "maximum"}.get(percentile, f"{percentile} %")
