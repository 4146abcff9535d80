"""The plugin in pvpython and pvbatch: every method, errors, states and traces."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bad_input import tables
from seeds import full_run

import symsurf

HOSTS = ["pvpython", pytest.param("pvbatch", marks=full_run)]


def check(answer: dict[str, Any]) -> None:
    assert answer["ports"] == ["Shape", "Mirror", "Surface Points"]
    assert list(answer["methods"]) == list(symsurf.methods())
    for method, found in answer["methods"].items():
        assert found["partners"] == found["points"] >= found["paired"]
        assert found["surface_points"] == found["vertices"] == found["residuals"]
        assert 0 <= found["field"]["Score"][0]
        if method == "cylinder" and not found["paired"]:  # none is a result, with few points
            assert "Kind" not in found["field"] and found["field"]["Score"] == [0]
            continue
        assert found["paired"] > 0 and found["surface_points"] > 0
        if "Kind" in found["field"]:
            assert found["triangles"] > 0
            assert {-1, 1} <= set(found["sides"]) <= {-1, 0, 1}  # 0: on the mirror, or without foot


@pytest.mark.parametrize("host", HOSTS)
def test_every_method_on_a_known_mirror(host: str, run_host: Callable[..., Any]) -> None:
    answer = run_host(host, "every_method.py")
    check(answer)
    plane = answer["methods"]["plane"]["field"]
    assert plane["Kind"] == "plane"
    normal, offset = np.array(plane["Normal"]), plane["Offset"][0]
    assert abs(abs(normal[0]) - 1) < 1e-9
    assert abs(offset + 0.25 * normal[0]) < 1e-6  # ParaView's sources are of single precision
    assert plane["Score"][0] > 0.9


def test_every_method_on_a_real_mesh(run_host: Callable[..., Any], shape_file: Path) -> None:
    answer = run_host("pvpython", "every_method.py", shape_file)
    check(answer)
    assert abs(answer["methods"]["plane"]["field"]["Normal"][0]) > 1 - 1e-6


def test_bad_input_leaves_the_session_alive(run_host: Callable[..., Any]) -> None:
    points = run_host("pvpython", "bad_input.py")
    assert points.pop("good") > 0
    assert points.pop("good, but for some") > 0
    assert points.pop("good again") > 0
    assert len(points) >= 5
    assert set(points.values()) == {0}


def test_the_tables_of_bad_input_leave_the_session_alive(run_host: Callable[..., Any]) -> None:
    outside = [
        ("".join(word.capitalize() for word in f"{method.name}_{parameter.name}".split("_")),
         method.name, parameter, value)
        for method in symsurf.methods().values()
        for parameter, value in tables.numbers_out_of_range(method.parameters)
    ]  # fmt: skip
    # JSON has no NaN.
    values = [
        [name, method, None if math.isnan(value) else value] for name, method, _, value in outside
    ]
    seen = run_host("pvpython", "bad_tables.py", json.dumps(values))
    reasons = {
        "clouds": [cloud.reason for cloud in tables.clouds()],
        "mirrors": [mirror.reason for mirror in tables.mirrors()],
        "properties": [f"{parameter.name} is " for _, _, parameter, _ in outside],
    }
    assert {kind: len(cases) for kind, cases in seen.items()} == {
        kind: len(cases) for kind, cases in reasons.items()
    }
    for kind, cases in seen.items():
        for case, reason in zip(cases, reasons[kind]):
            assert reason in case["said"] and case["points"] == 0
            assert case["good"] > 0 and case["said of good"] == ""


def test_state_and_trace_bring_the_same_mirror_back(
    run_host: Callable[..., Any], tmp_path: Path
) -> None:
    for kind in ("state.py", "trace.py"):
        before, after = run_host("pvpython", kind, tmp_path)
        assert before == after
    trace = (tmp_path / "trace_made.py").read_text()
    assert "MirrorDetection(" in trace
    assert re.search(r"\bMethod ?= ?'plane'", trace)  # ParaView 6: .Set(Method='plane')
    assert re.search(r"\bPlanePairDistance ?= ?0\.125\b", trace)


def test_reflection_lies_on_the_partners(run_host: Callable[..., Any]) -> None:
    assert run_host("pvpython", "reflection.py") < 1e-6


@pytest.mark.parametrize("host", HOSTS)
def test_candidates_are_shown_when_asked_for(host: str, run_host: Callable[..., Any]) -> None:
    seen = run_host(host, "candidates.py")
    assert len(seen["bounds"]) == 3 and seen["alone"] < seen["all"]
    assert np.allclose(seen["scores"], 1)
    fields = seen["field"]
    normals = np.reshape(fields["Normal"] + fields["CandidateNormals"], (3, 3))
    axes = np.abs(normals).argmax(axis=1)
    assert np.allclose(np.abs(normals), np.eye(3)[axes]) and set(axes) == {0, 1, 2}
    assert np.allclose(fields["CandidateOffsets"], 0, atol=1e-9)
    for bounds, axis in zip(seen["bounds"], axes):
        extent = np.diff(np.reshape(bounds, (3, 2)))[:, 0]
        assert np.flatnonzero(extent < 1e-9).tolist() == [axis]


@pytest.mark.parametrize("host", HOSTS)
def test_grids_blocks_and_images_are_shapes(host: str, run_host: Callable[..., Any]) -> None:
    seen = run_host(host, "shapes.py")
    expected = seen["mesh"]
    assert expected["verdict"] == "found"
    for kind in ("grid", "blocks"):
        sign = np.sign(np.dot(seen[kind]["normal"], expected["normal"]))
        assert np.allclose(seen[kind]["normal"], np.multiply(sign, expected["normal"]), atol=1e-6)
        assert abs(seen[kind]["offset"] - sign * expected["offset"]) < 1e-6
        assert seen[kind]["points"] == expected["points"]
    image = seen["image"]
    assert image["threshold"] == pytest.approx(image["middle"], rel=1e-6)
    assert abs(image["normal"][2]) > 1 - 1e-6 and abs(image["offset"]) < 1e-6
