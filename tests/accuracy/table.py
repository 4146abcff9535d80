"""The table: median, 90th percentile and share of success beside each bar."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from .case import Bar, Case, Figures

COLUMNS = ("case", "figure", "median", "90 %", "bar", "success", "")
WIDTHS = (40, 14, 10, 10, 11, 7, 4)


def line(cells: Sequence[str]) -> str:
    first, second, *rest = cells
    aligned = [first.ljust(WIDTHS[0]), second.ljust(WIDTHS[1])]
    aligned += [cell.rjust(width) for cell, width in zip(rest, WIDTHS[2:])]
    return " ".join(aligned).rstrip()


def rows(case: Case, title: str, trials: Sequence[Figures]) -> Iterator[str]:
    """One line a figure. Success: the share of trials that meet the bar; the last line counts
    those that meet all. Means stand for medians of figures that are 0 or 1."""
    names = list(dict.fromkeys(name for trial in trials for name in trial))
    for k, name in enumerate(names):
        values = np.array([trial.get(name, np.nan) for trial in trials])
        yield _row(title if k == 0 else "", name, values[~np.isnan(values)], case.bars.get(name))
    if len(case.bars) > 1:
        together = [all(bar.met(t[name]) for name, bar in case.bars.items()) for t in trials]
        yield line(("", "all bars", "", "", "", f"{np.mean(together):.0%}", ""))


def _row(title: str, name: str, values: np.ndarray, bar: Bar | None) -> str:
    yes_or_no = np.isin(values, (0, 1)).all()
    middle = values.mean() if yes_or_no else np.median(values)
    # The tenth that is worst.
    worst = np.quantile(values, 0.1 if bar and np.isinf(bar.high) else 0.9, method="nearest")
    cells = [title, name, f"{middle:.3g}", "" if yes_or_no else f"{worst:.3g}"]
    if not bar:
        return line([*cells, "", "", ""])
    success = np.mean([bar.met(value) for value in values])
    return line([*cells, str(bar), f"{success:.0%}", "" if bar.met(middle) else "miss"])
