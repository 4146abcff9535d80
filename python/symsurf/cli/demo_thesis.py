"""symsurf demo thesis: the thesis's tables, regenerated."""

from __future__ import annotations

import argparse

from ..thesis_tables import Outcome, measure, rows

ROW = "{:4} {:19} {:17} {:9} {:>10} {:>10}"


def run(arguments: argparse.Namespace) -> int:
    arguments.output.mkdir(parents=True, exist_ok=True)
    print(ROW.format("tab.", "method", "experiment", "figure", "found", "thesis"))
    for row in rows():
        outcome = measure(row)
        print("\n".join(_lines(outcome)), flush=True)
        if not arguments.no_pictures:
            from ..thesis_pictures import draw

            draw(outcome, arguments.output)
    return 0


def _lines(outcome: Outcome) -> list[str]:
    row = outcome.row
    printed = dict(zip(outcome.figures, row.printed))
    lines = []
    for name, value in outcome.figures.items():
        thesis = printed.get(name)
        shown = "-" if thesis is None else f"{thesis:.3g}"
        lines.append(ROW.format(row.table, row.method, row.name, name, f"{value:.3g}", shown))
    return lines
