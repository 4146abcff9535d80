"""symsurf demo thesis: the thesis's tables, regenerated."""

from __future__ import annotations

import argparse

from .._core import InvalidParameter
from ..plotting.drawing import import_pyvista
from ..thesis.pictures import draw
from ..thesis.tables import Outcome, measure, rows
from .terminal import say


def run(arguments: argparse.Namespace) -> int:
    listed = list(rows())
    if arguments.tables:
        numbers = list(dict.fromkeys(row.table for row in listed))
        for table in arguments.tables:
            if table not in numbers:
                raise InvalidParameter(f"tables is {table}; allowed are {', '.join(numbers)}")
        listed = [row for row in listed if row.table in arguments.tables]
    if not arguments.no_pictures:
        import_pyvista()  # missing, it is missed before the tables are made
        arguments.output.mkdir(parents=True, exist_ok=True)
    heading = ""
    for row in listed:
        outcome = measure(row)
        if heading != (heading := _heading(outcome)):
            say(f"\n{heading}")
        say(_line(outcome))
        if not arguments.no_pictures:
            draw(outcome, arguments.output)
    return 0


def _heading(outcome: Outcome) -> str:
    """Each error's column is followed by the thesis's."""
    columns = "".join(f"{name:>11}    thesis" for name in _errors(outcome))
    rest = "   coverage" if "coverage" in outcome.figures else ""
    return f"table {outcome.row.table}  {outcome.row.method:19}{columns}{rest}"


def _line(outcome: Outcome) -> str:
    printed = outcome.row.printed or [None] * len(_errors(outcome))
    columns = "".join(
        f"{value:11.3g}{'-' if thesis is None else format(thesis, '.3g'):>10}"
        for value, thesis in zip(_errors(outcome).values(), printed)
    )
    coverage = outcome.figures.get("coverage")
    rest = "" if coverage is None else f"{coverage:11.2f}"
    return f"           {outcome.row.name:19}{columns}{rest}"


def _errors(outcome: Outcome) -> dict[str, float]:
    return {name: value for name, value in outcome.figures.items() if name != "coverage"}
