"""The operations as ParaView's filters."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bad_input import tables
from desktop import screen
from seeds import full_run

import symsurf
from symsurf import _core

OPERATIONS = symsurf.operations()


def camel_case(name: str) -> str:
    return "".join(word[0].upper() + word[1:] for word in name.replace(" ", "_").split("_"))


PROXIES = {camel_case(operation.title): operation for operation in OPERATIONS.values()}


@pytest.mark.parametrize("host", ["pvpython", pytest.param("pvbatch", marks=full_run)])
def test_every_operation_gives_what_the_core_gives(
    host: str, run_host: Callable[..., Any], tmp_path: Path
) -> None:
    answer = run_host(host, "every_operation.py", tmp_path, *PROXIES)
    shape = np.load(tmp_path / "shape.npz")
    fields = answer["mirror"]
    mirror = symsurf.Plane(fields["Normal"], fields["Offset"][0])
    diagonal = np.linalg.norm(np.ptp(shape["points"], axis=0))
    for proxy, operation in PROXIES.items():
        found = np.load(tmp_path / f"{proxy}.npz")
        expected = _core.operate(
            operation.name, shape["points"], shape["faces"], mirror, None, 0, None, {}
        )
        assert np.abs(found["points"] - expected["points"]).max() <= 1e-12 * diagonal
        for array in operation.arrays:
            if array.name not in expected["arrays"]:
                continue
            np.testing.assert_allclose(
                found[proxy + camel_case(array.name)],
                expected["arrays"][array.name],
                rtol=0,
                atol=1e-9,
            )
        seen = answer["operations"][proxy]
        if len(expected["point_parents"]) == 0 or operation.carries_values:
            assert seen["apart"] < 1e-9
            assert seen["cells"] >= answer["cells"]
        assert seen["scalars"] == (proxy + camel_case(operation.shown) if operation.shown else None)
        assert set(seen["field"]) == set(map(camel_case, expected["statistics"]))
        assert len(seen["ports"]) == 1 + operation.adds_points
    assert answer["operations"]["MirrorCompletion"]["ports"] == ["Whole", "Patch"]


def test_asymmetry_after_a_detection_is_that_of_the_shape(run_host: Callable[..., Any]) -> None:
    seen = run_host("pvpython", "default_connections.py")
    assert seen["found"]["Maximum"] == pytest.approx([0.1], abs=0.015)
    assert seen["found"]["Maximum"] == pytest.approx(seen["known"]["Maximum"], abs=0.01)
    assert "the input is a mirror" in seen["no shape"]
    assert "connect output 1" in seen["no mirror"]


def test_bad_input_leaves_the_session_alive(run_host: Callable[..., Any]) -> None:
    outside = [
        (proxy, parameter, value)
        for proxy, operation in PROXIES.items()
        for parameter, value in tables.numbers_out_of_range(operation.parameters)
    ]
    # JSON has no NaN.
    values = [
        [proxy, camel_case(parameter.name), None if math.isnan(value) else value]
        for proxy, parameter, value in outside
    ]
    answer = run_host(
        "pvpython", "bad_operations.py", json.dumps(list(PROXIES)), json.dumps(values)
    )
    assert set(answer["mirrors"]) == set(PROXIES)
    for k, seen in enumerate(answer["mirrors"].values()):
        for said, row in zip(seen, tables.mirrors()[k :: len(PROXIES)], strict=True):
            assert row.reason in said["said"] and said["points"] == 0, row.name
    for k, seen in enumerate(answer["clouds"].values()):
        for said, row in zip(seen, tables.clouds()[k :: len(PROXIES)], strict=True):
            if row.refuses_nonfinite:  # some are left out: no property refuses them
                assert "finite" not in said["said"], row.name
                continue
            assert row.reason in said["said"] and said["points"] == 0, row.name
    for said, (_, parameter, _) in zip(answer["properties"], outside, strict=True):
        assert f"{parameter.name} is " in said["said"] and said["points"] == 0
    for name, (said, reason) in answer["masks"].items():
        assert reason in said["said"] and (said["points"] == 0) == bool(reason), name
    for proxy, seen in answer["good"].items():
        is_refused = PROXIES[proxy].needs_faces  # a cloud
        assert ("needs a mesh" in seen["said"]) == is_refused and (
            seen["points"] == 0
        ) == is_refused


def test_colours_of_the_asymmetry_lie_about_0(
    run_host: Callable[..., Any], environment: dict[str, str]
) -> None:
    with screen(environment) as seen:
        answer = run_host(f"env DISPLAY={seen['DISPLAY']} pvpython", "colours.py")
    assert answer["array"] == ["POINTS", "MirrorAsymmetrySigned"]
    end = 0.0
    for depth in ("0.2", "0.1", "0.3"):
        seen = answer[depth]
        assert 0 < seen["p99"] < seen["largest"]
        end = max(end, seen["p99"])  # it grows, as ParaView's own ranges do
        assert seen["colours"] == pytest.approx([-end, end], rel=1e-6)
        assert min(seen["of 0"]) > 0.85 and np.ptp(seen["of 0"]) < 0.02  # white
    assert answer["legend"] == "Signed asymmetry"
    assert np.ptp(answer["nan"]) == 0  # grey
    assert answer["own"]["colours"] == [0, 1]


def test_mirrors_are_translucent_and_legends_name_what_was_found(
    run_host: Callable[..., Any], environment: dict[str, str]
) -> None:
    with screen(environment) as seen:
        answer = run_host(f"env DISPLAY={seen['DISPLAY']} pvpython", "display.py")
    assert answer["several"]["opacity"] == 0.4 and answer["elements"]["opacity"] == 0.5
    assert answer["several"]["array"] == ["CELLS", "Rank"] and "Rank" not in answer["one"]
    assert answer["elements"]["array"] == ["CELLS", "ElementOrder"]
    assert answer["own"] == 0.9  # what is shown again stays as it was made
    assert answer["shape"]["legend"].startswith("plane, score 1.00, found\n")
    assert answer["elements"]["legend"].startswith("D6h, score ")
