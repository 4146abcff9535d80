"""What an object says of itself in a few words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from typing import Any

import numpy as np

from ..base.plain import without_rounding

_OF_DIAGONAL = "_of_diagonal"
_UNMATCHED = "unmatched_"


class Summarised:
    """Printed, and shown in a notebook, as the table of its ``summary``."""

    @property
    def summary(self) -> dict[str, str]:
        """What it says in a few words, by name."""
        raise NotImplementedError

    def __str__(self) -> str:
        lines = [(name, text.replace("\n", "\n" + 17 * " ")) for name, text in self.summary.items()]
        return "\n".join(f"{name:<16} {text}" for name, text in lines)

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(text).replace(chr(10), '<br>')}</td></tr>"
            for name, text in self.summary.items()
        )
        return f"<table>{rows}</table>"


def percent(share: float) -> str:
    """Never 100 % of less than all, never 0 % of some."""
    return "below 0.1 %" if 0 < share < 0.001 else f"{int(1000 * share) / 10:g} %"


def of_the_diagonal(share: float) -> str:
    """In digits that a reader compares: rounding errors read 0.000 %, not 4.3e-05 % or -0.000 %."""
    return f"{fixed(100 * share, 3)} % of the diagonal"


def fixed(value: float, digits: int) -> str:
    """With so many digits behind the point; what rounds to nothing is 0, not -0."""
    return f"{round(value, digits) + 0:.{digits}f}"


def figures(statistics: Mapping[str, Any]) -> Iterator[tuple[str, Any, float | None]]:
    """What is printed of statistics: name, value, and of a length its share of the diagonal. Reasons for
    which no point is unmatched are left out."""
    for name, value in statistics.items():
        if not name.endswith(_OF_DIAGONAL) and (not name.startswith(_UNMATCHED) or value):
            yield name, value, statistics.get(name + _OF_DIAGONAL)


def value_text(name: str, value: Any, of_diagonal: float | None = None) -> str:
    """A reported figure in words; of a length with its share of the diagonal."""
    if of_diagonal is not None:
        return f"{value:.4g} ({of_the_diagonal(of_diagonal)})"
    if name.endswith("_share") or name.startswith(_UNMATCHED):
        return percent(value)
    if isinstance(value, (list, np.ndarray)):
        numbers = np.atleast_2d(without_rounding(value))
        rows = ["  ".join(f"{number:.6g}" for number in row) for row in numbers]
        return "\n".join(rows)
    if value is None:  # in a record, what is no number
        return "nan"
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.6g}"
    return str(value)
