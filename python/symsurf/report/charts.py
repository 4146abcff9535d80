"""Histograms as SVG."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray

BAR = "#5b84b8"
INK = "#333333"


def histogram(values: NDArray[np.float64], label: str, of_what: str, symmetric: bool) -> str:
    """How many values fall where; a symmetric one says of the few farthest out only how many.

    Args:
        values: finite.
        label: of the axis, with the unit.
        of_what: what is counted.
        symmetric: about 0, with a line there.
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    low, high = _range(values, symmetric)
    inside = values[(values >= low) & (values <= high)]
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.add_subplot()
    bins = int(np.clip(2 * np.cbrt(max(1, len(inside))), 5, 81)) | 1  # odd: one about 0
    axes.hist(inside, bins=bins, range=(low, high), color=BAR)
    if symmetric:
        axes.axvline(0, color=INK, linewidth=0.8)
    if outside := len(values) - len(inside):
        axes.set_title(f"{outside} of {len(values)} {of_what} lie beyond", fontsize=9, color=INK)
    axes.set_xlabel(label)
    axes.set_ylabel(of_what)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.spines[["top", "right"]].set_visible(False)
    file = io.StringIO()
    # Texts stay texts, and the same values give the same bytes.
    with rc_context({"svg.fonttype": "none", "svg.hashsalt": "symsurf"}):
        figure.savefig(file, format="svg", transparent=True, metadata={"Date": None})
    return file.getvalue()[file.getvalue().index("<svg") :]


def _range(values: NDArray[np.float64], symmetric: bool) -> tuple[float, float]:
    """Where all lie, or about 0 all but one in a hundred; a width above 0."""
    if symmetric:
        end = float(np.percentile(np.abs(values), 99)) if len(values) else 0.0
        return (-end, end) if end > 0 else (-1.0, 1.0)
    low, high = float(values.min()), float(values.max())
    return (low, high) if high > low else (low - 0.5, high + 0.5)
