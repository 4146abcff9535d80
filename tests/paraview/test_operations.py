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


def directed_half() -> dict[str, Any]:
    """Half a bumpy ball about x = 0 with a bit of its other side, and directions of its points."""
    up, around = np.meshgrid(np.linspace(0.2, 2.9, 14), np.linspace(-1.8, 1.8, 18), indexing="ij")
    up, around = up.ravel(), around.ravel()
    ball = np.column_stack([np.sin(up) * np.cos(around), np.sin(up) * np.sin(around), np.cos(up)])
    points = ball * (0.6 + 0.1 * np.sin(3 * ball[:, 1:2]) + 0.08 * ball[:, 2:])
    i, j = np.meshgrid(np.arange(13), np.arange(17), indexing="ij")
    corner = (18 * i + j).ravel()
    faces = np.vstack([corner + np.array([[0], [18], [19]]), corner + np.array([[0], [19], [1]])])
    random = np.random.default_rng(0)
    normals = ball / np.linalg.norm(ball, axis=1, keepdims=True)
    square = random.normal(size=(len(ball), 3, 3))
    return {
        "points": points,
        "faces": np.ascontiguousarray(faces.reshape(2, 3, -1).swapaxes(1, 2).reshape(-1, 3)),
        "Vectors": random.normal(size=points.shape),
        "Normals": normals,
        "Tensors": (square + square.swapaxes(1, 2)).reshape(-1, 9),
    }


def free_form() -> symsurf.Mirror:
    x, y = np.meshgrid(np.linspace(-1, 1, 40), np.linspace(-1, 1, 40))
    heights = 0.1 * x * x - 0.05 * x * y + 0.08 * np.sin(2 * y)
    return symsurf.fit_mirror(np.column_stack([heights.ravel(), x.ravel(), y.ravel()]), "free-form")


DIRECTED: dict[str, dict[str, Any]] = {
    "MirrorAlignment": {},
    "MirrorStraightening": {},
    "MirrorCompletion": {"search": False},
    "MirrorTransfer": {},
    "MirrorSymmetrization": {"triangles": "mirrored"},
    "MirrorRemeshing": {},
    "MirrorCut": {},
}
EXACT = 1e-9


def test_directions_are_carried_as_in_python(run_host: Callable[..., Any], tmp_path: Path) -> None:
    given = directed_half()
    mirrors: dict[str, symsurf.Mirror] = {
        "plane": symsurf.Plane((1, 0.1, 0), 0.02),
        "sphere": symsurf.Sphere((-3, 0, 0), 3.05),
        "cylinder": symsurf.Cylinder((-3, 0, 0), (0, 0.2, 1), 3.05),
        "free-form": free_form(),
    }
    np.savez(tmp_path / "shape.npz", **given)
    numbers = {
        name: (each.kind, {key: np.asarray(value).tolist() for key, value in each.numbers.items()})
        for name, each in mirrors.items()
    }
    (tmp_path / "mirrors.json").write_text(json.dumps(numbers))
    proxies = ["MirrorReflection", *DIRECTED]
    words = [
        f"{proxy}:Triangles=mirrored"
        if proxy == "MirrorSymmetrization"
        else f"{proxy}:Search=0"
        if proxy == "MirrorCompletion"
        else proxy
        for proxy in proxies
    ]
    run_host("pvpython", "directions.py", tmp_path, *words)
    kinds = {"Vectors": "vector", "Normals": "normal", "Tensors": "tensor"}
    for name, mirror in mirrors.items():
        own = symsurf.make_mirror(mirror.kind, mirror.numbers)
        for proxy in proxies:
            seen = np.load(tmp_path / f"{name}-{proxy}.npz")
            if proxy == "MirrorReflection":
                carried = _core.AttributeTransform(own, given["points"])
                expected = {each: carried(given[each], kind) for each, kind in kinds.items()}
            else:
                made = getattr(symsurf, PROXIES[proxy].name)(
                    *([None] if proxy == "MirrorTransfer" else []),
                    symsurf.Shape(given["points"], given["faces"]),
                    own,
                    **DIRECTED[proxy],
                )
                np.testing.assert_allclose(seen["points"], made.shape.points, atol=EXACT)
                expected = {each: made.carried(given[each], kind) for each, kind in kinds.items()}
                if proxy == "MirrorTransfer":
                    expected["Normals"] = given["Normals"]  # the points', which stay
            for each, values in expected.items():
                np.testing.assert_allclose(
                    seen[each], values, atol=EXACT, err_msg=f"{name} {proxy} {each}"
                )
