"""Scenes of several parts: one result, or one row, for each."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_line import run_here

import symsurf
from symsurf import Shape


def half_ellipsoid(count: int, seed: int) -> np.ndarray:
    """Points with the mirror x = 0 alone."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    _, y, z = points.T
    return points * (1, 2, 1.5) * (1 + 0.3 * y + 0.2 * z * y)[:, None]


def scene() -> np.ndarray:
    """Three of them, 10 apart along x."""
    return np.vstack([half_ellipsoid(1500, k) + (10 * k, 0, 0) for k in range(3)])


def offsets(found: list[symsurf.Result]) -> list[float]:
    return [abs(result.mirror.offset) for result in found]


def test_a_cloud_has_a_result_for_each_connected_part():
    found = symsurf.detect(scene(), "plane", parts="connected")
    assert [len(result.points) for result in found] == [1500] * 3
    np.testing.assert_allclose(offsets(found), [0, 10, 20], atol=0.1)
    groups = symsurf.symmetries(scene(), parts="connected")
    assert [each.group for each in groups] == ["Cs"] * 3


def test_order_and_stray_points():
    points = scene()
    shuffled = np.vstack([points[::-1], [[500, 0, 0], [np.nan, 0, 0]]])
    found = symsurf.detect(shuffled, "plane", parts="connected")
    np.testing.assert_allclose(offsets(found), [20, 10, 0], atol=0.1)


def test_labels_choose_the_parts():
    labels = np.repeat([2.0, np.nan, 1.0], 1500)
    found = symsurf.detect(scene(), "plane", parts=labels)
    np.testing.assert_allclose(offsets(found), [20, 0], atol=0.1)
    with pytest.raises(symsurf.InvalidParameter, match=r"one label per point, \(4500,\)"):
        symsurf.detect(scene(), parts=labels[1:])
    with pytest.raises(symsurf.InvalidParameter, match="allowed are connected"):
        symsurf.detect(scene(), parts="bones")
    with pytest.raises(symsurf.InvalidInput, match="no part has 10 points"):
        symsurf.detect(scene(), parts=np.arange(4500))


def test_meshes_by_faces_and_by_arrays():
    pyvista = pytest.importorskip("pyvista")
    balls = [pyvista.Sphere(center=(1.01 * k, 0, 0)) for k in range(3)]  # nearly touching
    mesh = balls[0].append_polydata(*balls[1:])
    found = symsurf.detect(mesh, "plane", parts="connected")
    assert [len(result.points) for result in found] == [ball.n_points for ball in balls]
    mesh.point_data["bone"] = (np.asarray(mesh.points)[:, 0] > 0.5).astype(int)
    assert len(symsurf.symmetries(mesh, parts="bone")) == 2


def test_unmerged_triangles_are_connected_by_their_corners():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    soup = np.vstack([corners[faces].reshape(-1, 3) + (5 * k, 0, 0) for k in range(2)])
    shape = Shape(soup, np.arange(24).reshape(-1, 3))
    assert [each.shape.faces.shape for each in symsurf.symmetries(shape, parts="connected")] == [
        (4, 3)
    ] * 2


def test_tables_have_a_row_for_each_part(tmp_path):
    np.savetxt(tmp_path / "scene.xyz", scene(), fmt="%.17g")
    rows = list(symsurf.batch(tmp_path / "scene.xyz", method="plane", parts="connected"))
    assert [row["part"] for row in rows] == [0, 1, 2]
    assert [row["points"] for row in rows] == [1500] * 3
    ran = run_here(
        "detect scene.xyz --method plane --parts connected --table t.csv --json", tmp_path
    )
    assert ran.returncode == 0, ran.stderr
    assert [json.loads(line)["part"] for line in ran.stdout.splitlines()] == [0, 1, 2]
    again = run_here(
        "detect scene.xyz --method plane --parts connected --table t.csv --resume", tmp_path
    )
    assert again.returncode == 0 and again.stdout == ""
    ran = run_here("symmetries scene.xyz --parts connected", tmp_path)
    assert ran.stdout.count("group     Cs") == 3 and "scene.xyz, part 2" in ran.stdout
    ran = run_here("detect scene.xyz --parts connected -o found", tmp_path)
    assert ran.returncode == 2 and "output is given beside parts" in ran.stderr
