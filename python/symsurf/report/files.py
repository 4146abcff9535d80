"""The page of many shapes: a row each, and percentiles over all of them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np

from .charts import histogram
from .html import Html, heading, page, paragraph, ranks_of, table

PERCENTILES = (0, 5, 25, 50, 75, 95, 100)
# Of the columns of a batch: their names here, and what they are multiplied by. Lengths are shares
# of the diagonal: shapes differ in size.
_FIGURES = {
    "score": ("score", 1),
    "paired_share": ("paired, %", 100),
    "mean_of_diagonal": ("mean, % of the diagonal", 100),
    "rms_of_diagonal": ("rms, % of the diagonal", 100),
    "median_of_diagonal": ("median, % of the diagonal", 100),
    "p95_of_diagonal": ("95th percentile, % of the diagonal", 100),
    "maximum_of_diagonal": ("maximum, % of the diagonal", 100),
    "signed_mean_of_diagonal": ("signed mean, % of the diagonal", 100),
    "area_index": ("area index", 1),
    "volume_index": ("volume index", 1),
}
_SHOWN = ("score", "paired_share", "rms_of_diagonal", "p95_of_diagonal", "maximum_of_diagonal")


def files_page(title: str, rows: Sequence[Mapping[str, Any]], links: Mapping[str, str]) -> bytes:
    """The page of a batch of asymmetries.

    Args:
        rows: of ``symsurf.batch``.
        links: the page of each file, relative to this.
    """
    good = [row for row in rows if not row["error"]]
    doubtful = sum(row["verdict"] == "none" for row in good)
    sentence = f"{len(good) - doubtful} of {len(rows)} files have a mirror."
    if doubtful:
        sentence += f' {doubtful} more, with the verdict "none", are among the figures.'
    parts = [paragraph(sentence)]
    if good:
        rms = 100 * _column(good, "rms_of_diagonal")
        label = "root mean square of the asymmetry, % of the diagonal"
        parts += [
            heading("Over all files"),
            table(_percentile_rows(good), ("", *(_name(p) for p in PERCENTILES), "files")),
            histogram(rms, label, "files", symmetric=False),
        ]
        names = (
            "file",
            "mirror",
            "verdict",
            *(_FIGURES[name][0] for name in _SHOWN),
            "rank by rms",
        )
        parts += [heading("Files"), table(_file_rows(good, links), names)]
    if errors := [(Path(row["file"]).name, row["error"]) for row in rows if row["error"]]:
        parts += [heading("Files that failed"), table(errors, ("file", "reason"), numbers=False)]
    return page(title, parts)


def _percentile_rows(good: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    made = []
    for name, (title, factor) in _FIGURES.items():
        values = factor * _column(good, name)
        if len(values):
            percentiles = np.percentile(values, PERCENTILES).tolist()
            made.append([title, *(f"{value:.4g}" for value in percentiles), str(len(values))])
    return made


def _file_rows(good: Sequence[Mapping[str, Any]], links: Mapping[str, str]) -> list[list[str]]:
    ranks = ranks_of(_column(good, "rms_of_diagonal"))
    made = []
    for row, rank in zip(good, ranks, strict=True):
        target = quote(os.fsencode(links[row["file"]]))
        link = Html(f'<a href="{target}">{escape(Path(row["file"]).name)}</a>')
        figures = [f"{_FIGURES[key][1] * row[key]:.4g}" if key in row else "" for key in _SHOWN]
        made.append([link, row["kind"], row["verdict"], *figures, rank])
    return made


def _column(rows: Sequence[Mapping[str, Any]], name: str) -> np.ndarray:
    return np.array([row[name] for row in rows if name in row], dtype=float)


def _name(percentile: int) -> str:
    return {0: "minimum", 50: "median", 100: "maximum"}.get(percentile, f"{percentile} %")
