"""Springs and threads: axis, pitch, handedness and ends, in Python and on the command line."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_line import run_here

import symsurf


def rod(pitch: float, steps: int = 240, around: int = 60) -> symsurf.Shape:
    """A right-handed thread from z = 0 to 2 and a smooth shank from there to 3, about the z axis."""
    z, angle = np.meshgrid(np.linspace(0, 3, steps), np.linspace(0, 2 * np.pi, around, endpoint=False), indexing="ij")  # fmt: skip
    ridge = np.abs(2 * ((z / pitch - angle / (2 * np.pi)) % 1) - 1)
    r = np.where(z < 2, 0.5 - 0.5 * pitch * ridge, 0.5)
    i, j = np.meshgrid(np.arange(steps - 1), np.arange(around), indexing="ij")
    a, b = (i * around + j).ravel(), (i * around + (j + 1) % around).ravel()
    faces = np.vstack([np.stack([a, b, b + around], 1), np.stack([a, b + around, a + around], 1)])
    points = np.stack([r * np.cos(angle), r * np.sin(angle), z], -1).reshape(-1, 3)
    return symsurf.Shape(points, faces)


@pytest.mark.parametrize("hand", ["right", "left"])
def test_a_thread_is_measured_and_its_shank_left_out(hand):
    shape = rod(0.2)
    sign = 1 if hand == "right" else -1
    found = symsurf.helical_symmetry(shape.points * (1, sign, 1), faces=shape.faces)
    assert found.verdict == "found" and found.reason == "" and found.handedness == hand
    assert found.pitch == pytest.approx(0.2, rel=0.01)
    assert abs(found.axis.direction[2]) > np.cos(np.radians(0.5))
    np.testing.assert_allclose(np.sort(found.ends[:, 2]), [0, 2], atol=0.15)
    z = shape.points[:, 2]
    assert found.arrays["helical"][(z > 0.2) & (z < 1.8)].all()
    assert not found.arrays["helical"][z > 2.2].any()
    screw = found.transformations[0]
    assert screw.kind == "screw"
    assert abs(screw.matrix[2, 3]) == pytest.approx(0.05, rel=0.05)


def test_a_cylinder_has_none(tmp_path):
    t = np.random.default_rng(0).uniform(0, 2 * np.pi, 2000)
    points = np.stack([np.cos(t), np.sin(t), np.linspace(0, 3, 2000)], axis=1)
    found = symsurf.helical_symmetry(points)
    assert found.verdict == "none" and "evidence" in found.reason
    assert found.axis is None and np.isnan(found.pitch) and found.handedness == ""
    assert np.isnan(found.ends).all() and found.ends.shape == (2, 3)
    found.save(tmp_path / "none.json")
    assert json.loads((tmp_path / "none.json").read_text())["statistics"]["verdict"] == "none"


def test_on_the_command_line(tmp_path):
    np.savetxt(tmp_path / "rod.xyz", rod(0.25).points, fmt="%.17g")
    ran = run_here("helical_symmetry rod.xyz --json", tmp_path)
    assert ran.returncode == 0, ran.stderr
    figures = json.loads(ran.stdout)["statistics"]
    assert figures["handedness"] == "right" and figures["pitch"] == pytest.approx(0.25, rel=0.01)
