"""The assignment of rows to columns that costs least."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def assignment(costs: NDArray[np.float64]) -> NDArray[np.int64]:
    """The column (k,) of each row of costs (k, k), each once, with the least sum.

    By shortest augmenting paths (Jonker and Volgenant 1987): k^3 steps, of which numpy takes k at
    once.
    """
    count = len(costs)
    row_prices, column_prices = np.zeros(count + 1), np.zeros(count + 1)
    row_of = np.full(count + 1, count)  # of each column; the last one is where a path begins
    for row in range(count):
        row_of[count] = row
        _augment(costs, row_prices, column_prices, row_of)
    columns = np.empty(count, np.int64)
    columns[row_of[:count]] = np.arange(count)
    return columns


def _augment(
    costs: NDArray[np.float64],
    row_prices: NDArray[np.float64],
    column_prices: NDArray[np.float64],
    row_of: NDArray[np.int64],
) -> None:
    """Adds the row that stands at the last column, along the cheapest path to a free column."""
    count = len(costs)
    cheapest = np.full(count, np.inf)
    before = np.full(count, count)
    seen = np.zeros(count + 1, bool)
    column = count
    while row_of[column] < count or column == count:
        seen[column] = True
        row = row_of[column]
        reduced = costs[row] - row_prices[row] - column_prices[:count]
        is_better = ~seen[:count] & (reduced < cheapest)
        cheapest[is_better], before[is_better] = reduced[is_better], column
        column = int(np.where(seen[:count], np.inf, cheapest).argmin())
        step = cheapest[column]
        row_prices[row_of[seen]] += step
        column_prices[seen] -= step
        cheapest[~seen[:count]] -= step
    while column != count:
        row_of[column] = row_of[before[column]]
        column = before[column]
