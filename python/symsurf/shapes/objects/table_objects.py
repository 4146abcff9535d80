"""Tables of points, one row per point: pandas' and polars'."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._core import InvalidInput
from ...base.input_warning import warn_of
from ..columns import columns_of
from ..kinds import column_groups, kept_as_number, unknown_groups
from .parts import Parts, Remade


def parts_of(given: Any) -> Parts:
    """The columns x, y and z, in capitals or not, or else the three that hold numbers."""
    return Parts(np.column_stack([np.asarray(given[name], float) for name in _axes(given)]))


def remade(given: Any, made: Remade) -> Any:
    """A table with all columns, those of the points moved and the arrays behind them; of three-dimensional
    arrays a column a coordinate. Pandas' row labels are kept where the points are the table's own."""
    axes = dict(zip(_axes(given), made.points.T, strict=True)) if made.moved else {}
    columns = {name: made.of_points(given[name]) for name in given.columns}
    names = [*map(str, given.columns)]
    warn_of(map(kept_as_number, unknown_groups(names, made.kinds) if made.turns else ()))
    for name, kind, group in column_groups(names, made.kinds):
        turned = made.of_points(
            np.column_stack([np.asarray(given[each]) for each in group]), name, kind
        )
        columns |= dict(zip(group, turned.T, strict=True))
    table = type(given)(columns | axes | columns_of(made.arrays))
    if hasattr(table, "iloc"):
        table.attrs = dict(given.attrs)
        for name in given.columns:
            if name not in axes or given[name].dtype.kind == "f":
                table[name] = table[name].astype(given[name].dtype)  # such as categories
        if len(table) == len(given):
            table.index = given.index
    return table


def _axes(given: Any) -> list[Any]:
    named = {str(name).lower(): name for name in given.columns}
    if {"x", "y", "z"} <= set(named):
        return [named[axis] for axis in "xyz"]
    numbers = [name for name in given.columns if np.asarray(given[name]).dtype.kind in "fiu"]
    if len(numbers) == 3:
        return numbers
    raise InvalidInput(
        f"the columns of the {type(given).__name__} are {', '.join(map(str, given.columns))}; allowed are "
        "some with x, y and z among them, or with three that hold numbers"
    )
