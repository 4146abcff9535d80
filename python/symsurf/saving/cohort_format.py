"""Cohorts as tables: one row per term of the ANOVA, and one per individual."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..morphometrics import Cohort
from .csv_rows import cells_of, rows_bytes

INDIVIDUAL_COLUMNS = ("individual", "size", "asymmetry", "fluctuating", "largest")


def anova_rows(cohort: Cohort) -> list[dict[str, Any]]:
    """The table, the name of a row in "source"."""
    return [{"source": name, **row} for name, row in cohort.table.items()]


def individual_rows(cohort: Cohort, labels: Sequence[str]) -> list[dict[str, Any]]:
    """Of each individual its centroid size, in input units, and at unit size the Procrustes lengths
    of its asymmetry, with and without the directional part, and its largest at one landmark."""
    lengths = (
        cohort.size.mean(axis=1),
        np.linalg.norm(cohort.asymmetric, axis=(1, 2)),
        np.linalg.norm(cohort.fluctuating, axis=(1, 2)),
        cohort.magnitude.max(axis=1),
    )
    rows = zip(labels, *(each.tolist() for each in lengths), strict=True)
    return [dict(zip(INDIVIDUAL_COLUMNS, row, strict=True)) for row in rows]


def table_bytes(rows: Sequence[Mapping[str, Any]]) -> bytes:
    """The rows as a CSV, with those columns that the first has."""
    return rows_bytes(map(cells_of, rows), list(rows[0]))
