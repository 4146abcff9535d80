"""What an object says of itself in a few words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from html import escape
from typing import Any

import numpy as np

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
    """Never 100 % of less than all."""
    return f"{int(1000 * share) / 10:g} %"


def of_the_diagonal(share: float) -> str:
    """In digits that a reader compares: what is nothing reads 0.000 %, not 4.3e-05 %."""
    return f"{100 * share:.3f} % of the diagonal"


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
    if isinstance(value, np.ndarray):
        rows = ["  ".join(f"{number:.6g}" for number in row) for row in np.atleast_2d(value)]
        return "\n".join(rows)
    return f"{value:.4g}" if isinstance(value, float) else str(value)
