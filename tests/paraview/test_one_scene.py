"""One scene through every front end: the same mirrors."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import BUILD

import symsurf

# The cylinder finds none in the scene.
METHODS = ["plane", "sphere", "quadric", "fixed_direction", "perpendicular"]
Mirrors = dict[str, dict[str, np.ndarray]]


def scene() -> np.ndarray:
    """A dented ball and its reflection, with noise: no front end gets round figures."""
    rng = np.random.default_rng(8)
    x = rng.normal(size=(400, 3))
    x /= np.linalg.norm(x, axis=1)[:, None]
    x *= (1 + 0.3 * np.sin(3 * x[:, 0] + x[:, 1]) + 0.2 * x[:, 1] * x[:, 2])[:, None]
    both = np.vstack([x, symsurf.Plane([1, 2, -0.5], 1.3).reflect(x)])
    return both + rng.normal(size=both.shape) * 1e-3


def plain(name: str) -> str:
    """A number's name without the front ends' ways of writing it: "CentreOfAll", "centre_of_all"."""
    return name.replace("_", "").lower()


def by_python(points: np.ndarray) -> Mirrors:
    found = {name: symsurf.detect(points, name) for name in METHODS}
    return {
        name: {plain(key): np.ravel(value) for key, value in result.mirror.numbers.items()}
        | {"score": np.ravel(result.score)}
        | of_candidates(result.candidates)
        for name, result in found.items()
    }


def of_candidates(candidates: list[symsurf.Result]) -> dict[str, np.ndarray]:
    numbers = {"scores": [candidate.score for candidate in candidates]}
    if all(isinstance(candidate.mirror, symsurf.Plane) for candidate in candidates):
        numbers["normals"] = [candidate.mirror.normal for candidate in candidates]
        numbers["offsets"] = [candidate.mirror.offset for candidate in candidates]
    return {f"candidate{name}": np.ravel(rows) for name, rows in numbers.items() if rows}


def by_pip_vtk(points: np.ndarray) -> Mirrors:
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from symsurf.vtk import MirrorDetection

    vtk_points, data = vtkPoints(), vtkPolyData()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    data.SetPoints(vtk_points)
    mirrors = {}
    for name in METHODS:
        detection = MirrorDetection()
        detection.SetInputData(data)
        detection.SetMethod(name)
        detection.Update()
        fields = detection.GetOutput(detection.MIRROR).GetFieldData()
        arrays = [fields.GetArray(i) for i in range(fields.GetNumberOfArrays())]
        mirrors[name] = {plain(a.GetName()): vtk_to_numpy(a).ravel() for a in arrays if a}
    return mirrors


def by_compiled_program(file: Path) -> dict[str, Mirrors]:
    program = BUILD / "bin" / "symsurf_one_scene"
    if not program.exists():
        pytest.skip(f"{program} is not built")
    done = subprocess.run([program, file, *METHODS], check=True, capture_output=True, text=True)
    found: dict[str, Mirrors] = {}
    for line in done.stdout.splitlines():
        front_end, method, name, *values = line.split()
        numbers = found.setdefault(front_end, {}).setdefault(method, {})
        numbers[plain(name)] = np.array(values, float)
    return found


def assert_same(found: Mirrors, expected: Mirrors, diagonal: float) -> None:
    assert list(found) == list(expected)
    for method, numbers in expected.items():
        for name, value in numbers.items():
            difference = np.abs(np.ravel(found[method][name]) - value)
            assert np.all(difference <= 1e-12 * np.maximum(diagonal, np.abs(value))), (method, name)


@pytest.fixture(scope="module")
def points() -> np.ndarray:
    return scene()


@pytest.fixture(scope="module")
def expected(points: np.ndarray) -> Mirrors:
    return by_python(points)


@pytest.fixture
def file(points: np.ndarray, tmp_path: Path) -> Path:
    points.tofile(tmp_path / "points")
    return tmp_path / "points"


def test_core_and_vtk(points: np.ndarray, expected: Mirrors, file: Path) -> None:
    found = by_compiled_program(file)
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
    assert set(found) == {"core", "vtk"}
    for mirrors in found.values():
        assert_same(mirrors, expected, diagonal)


def test_vtk_of_pip(points: np.ndarray, expected: Mirrors) -> None:
    pytest.importorskip("vtkmodules", reason="needs the vtk package")
    assert_same(by_pip_vtk(points), expected, float(np.linalg.norm(np.ptp(points, axis=0))))


def test_wrapped_vtk_and_paraview(
    points: np.ndarray, expected: Mirrors, file: Path, run_host: Callable[..., Any]
) -> None:
    answers = run_host("pvpython", "one_scene.py", file, *METHODS)
    assert set(answers) == {"wrapped", "paraview"}
    for mirrors in answers.values():
        named = {m: {plain(k): v for k, v in numbers.items()} for m, numbers in mirrors.items()}
        assert_same(named, expected, float(np.linalg.norm(np.ptp(points, axis=0))))
