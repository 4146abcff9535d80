"""The table that tests/accuracy prints."""

from accuracy.case import Case, at_least, at_most, within
from accuracy.table import rows


def test_rows_have_the_worst_tenth_and_say_what_misses_its_bar():
    bars = {"found": at_least(0.5), "error": at_most(4), "ratio": within(0.6, 1.4)}
    case = Case("case", ("subject",), lambda _subject, _rng: {}, bars)
    trials = [{"found": float(k > 2), "error": float(k), "ratio": k / 4} for k in range(10)]
    found, error, ratio, together = (row.split() for row in rows(case, case.name, trials))
    assert found == ["case", "found", "0.7", ">=", "0.5", "70%"]
    assert error == ["error", "4.5", "8", "<=", "4", "50%", "miss"]
    assert ratio == ["ratio", "1.12", "2", "0.6", "to", "1.4", "30%"]
    assert together == ["all", "bars", "20%"]
