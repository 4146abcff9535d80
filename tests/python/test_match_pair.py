"""Two shapes of a pair: laid onto each other, in Python and on the command line."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_line import run_here
from symmetric_shapes import random_rotation

import symsurf
from symsurf import Shape


def body(seed: int = 0, count: int = 2000) -> np.ndarray:
    """Random points of a body without a mirror."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    x, y, z = points.T
    return points * np.exp(0.2 * (np.sin(3 * x + 1) + np.cos(4 * y - z) + np.sin(2 * z + 2 * x * y)))[:, None]  # fmt: skip


def image(points: np.ndarray, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """The points reflected and placed, and the map."""
    rng = np.random.default_rng(seed)
    matrix = np.eye(4)
    matrix[:3, :3] = random_rotation(rng) @ np.diag([-1, 1, 1])
    matrix[:3, 3] = rng.normal(size=3)
    return points @ matrix[:3, :3].T + matrix[:3, 3], matrix


def test_a_shape_is_laid_on_its_image():
    left = body()
    right, matrix = image(left)
    found = symsurf.match_pair(left, right)
    assert found.verdict == "found" and found.score == pytest.approx(1)
    np.testing.assert_allclose(found.matrix, matrix, atol=1e-9)
    np.testing.assert_array_equal(found.index, np.arange(len(left)))
    assert np.linalg.det(found.matrix[:3, :3]) == pytest.approx(-1)
    assert repr(found) == "PairMatch(Shape(2000 points, no faces, no normals), found, score 1.000)"


def test_what_is_no_pair_is_told(tmp_path):
    found = symsurf.match_pair(body(), np.random.default_rng(0).uniform(-1, 1, (2000, 3)))
    assert found.verdict == "none" and "minimum_score" in found.reason
    found.save(tmp_path / "none.json")
    assert json.loads((tmp_path / "none.json").read_text())["statistics"]["verdict"] == "none"


def test_shapes_of_different_size_are_refused():
    with pytest.raises(symsurf.InvalidInput, match="both must be in one unit"):
        symsurf.match_pair(body(), 10 * body())
    with pytest.raises(TypeError):
        symsurf.match_pair(body())
    with pytest.raises(symsurf.InvalidInput, match="symmetries takes no second shape"):
        symsurf.shape_analyses.analyse.analyse("symmetries", body(), body())


def test_files_and_folders_of_them(tmp_path):
    right, matrix = image(body())
    (tmp_path / "left").mkdir()
    (tmp_path / "right").mkdir()
    np.savetxt(tmp_path / "left" / "a.xyz", body(), fmt="%.17g")
    np.savetxt(tmp_path / "right" / "a.xyz", right, fmt="%.17g")
    for other in ("right/a.xyz", "right"):
        ran = run_here(f"match_pair left/a.xyz --other {other} --json", tmp_path)
        found = json.loads(ran.stdout)["transformations"][0]
        np.testing.assert_allclose(found["matrix"], matrix, atol=1e-9)
    ran = run_here("match_pair left/a.xyz --other right/b.xyz", tmp_path)
    assert ran.returncode == 1 and "b.xyz" in ran.stderr


def test_meshes():
    pyvista = pytest.importorskip("pyvista")
    hills = pyvista.examples.load_random_hills()
    right = hills.reflect((0, 1, 0)).rotate_x(50)
    found = symsurf.match_pair(hills, right)
    np.testing.assert_allclose(hills.transform(found.matrix, inplace=False).points, right.points, atol=1e-4)  # fmt: skip
    assert isinstance(found.shape, Shape) and found.arrays["distance"].max() < 1e-4
