"""The analyses as ParaView's filter."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import symsurf


def camel_case(name: str) -> str:
    return "".join(word[0].upper() + word[1:] for word in name.replace(" ", "_").split("_"))


def test_every_analysis_gives_what_it_describes(run_host: Callable[..., Any]) -> None:
    analyses = symsurf.analyses()
    answers = run_host("pvpython", "every_analysis.py", *analyses)
    for name, analysis in analyses.items():
        found = answers[name]
        assert found["ports"] == ["Shape", "Elements", "Transformations"]
        assert found["field"]["Analysis"] == name
        for array in analysis.arrays:
            assert camel_case(analysis.title) + camel_case(array.name) in found["arrays"]
    group = answers["symmetries"]
    assert group["field"]["Group"] == "D2h"
    assert group["lines"] == 3  # the axes
    assert sorted(group["determinants"]) == pytest.approx([-1] * 4 + [1] * 4)
