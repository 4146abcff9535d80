"""Bands, patches and the symmetry value of parts whose offsets are known."""

import json

import numpy as np
import pytest
import pyvista
from command_line import run_here

import symsurf

PLANE = symsurf.Plane((1, 0, 0), 0)
BUMPS = [((0.6, 0.8, 0), 0.05), ((0.6, -0.8, 0), 0.03), ((0.8, 0, 0.6), 0.02)]  # direction, height


def bumpy(bumps=BUMPS):
    """A ball of radius 1 with bumps on one side, each over an angle of 0.25."""
    mesh = pyvista.Icosphere(radius=1, nsub=5)
    points = np.asarray(mesh.points, dtype=float)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    height = np.zeros(len(points))
    for direction, top in bumps:
        away = np.arccos(np.clip(points @ direction, -1, 1)) / 0.25
        height += top * np.where(away < 1, (1 - away**2) ** 2, 0)
    return symsurf.Shape(points * (1 + height)[:, None], mesh.regular_faces), points, height


@pytest.mark.parametrize("is_mesh", [True, False])
def test_bumps_are_patches_on_both_sides(is_mesh):
    shape, points, height = bumpy()
    given = shape if is_mesh else symsurf.Shape(shape.points)
    made = symsurf.asymmetry(given, PLANE, bands=(0.1, 0.012))
    assert [band.limit for band in made.bands] == [0.012, 0.1]
    assert len(made.patches) == 2 * len(BUMPS)
    assert [patch.largest for patch in made.patches] == sorted(
        (patch.largest for patch in made.patches), reverse=True
    )
    for (direction, top), pair in zip(BUMPS, np.array(made.patches).reshape(-1, 2), strict=True):
        places = np.abs([patch.place / np.linalg.norm(patch.place) for patch in pair])
        assert (np.linalg.norm(places - np.abs(direction), axis=1) < 0.08).all()
        assert [patch.largest for patch in pair] == pytest.approx([top, top], rel=0.15)
    # Caps of the unit sphere: where the bump is higher than the limit, on both sides.
    angles = [0.25 * np.sqrt(1 - np.sqrt(0.012 / top)) for _, top in BUMPS]
    beyond = 2 * sum(0.5 * (1 - np.cos(angle)) for angle in angles)
    twice = np.maximum(height, height_of_images(points))
    within = 1 - beyond if is_mesh else (twice <= 0.012).mean()
    assert made.bands[0].share == pytest.approx(within, abs=0.003)
    assert made.bands[1].share == 1
    if is_mesh:
        assert made.bands[0].area == pytest.approx(4 * np.pi * within, rel=0.01)
        area = sum(patch.area for patch in made.patches)
        assert area == pytest.approx(4 * np.pi * beyond, rel=0.1)
    else:
        assert np.isnan(made.bands[0].area)
    json.dumps(made.to_json())


def height_of_images(points):
    flipped = points * (-1, 1, 1)
    return sum(
        top * np.where(away < 1, (1 - away**2) ** 2, 0)
        for direction, top in BUMPS
        for away in [np.arccos(np.clip(flipped @ direction, -1, 1)) / 0.25]
    )


def test_the_symmetry_value_is_twice_the_offset_of_the_middle():
    """Two opposite sides of a box, the one 0.2 farther from the datum than the other: their middle lies 0.1
    beside it."""
    box = pyvista.Box((-1, 1.2, -2, 2, -3, 3), level=10).triangulate()
    shape = symsurf.Shape(np.round(box.points.astype(float), 6), box.regular_faces)
    made = symsurf.asymmetry(shape, PLANE, bands=0.1)
    assert made.statistics["symmetry_value"] == pytest.approx(0.2, abs=1e-9)
    exact = symsurf.asymmetry(shape, "x=0.1", bands=0.1)
    assert exact.statistics["symmetry_value"] == pytest.approx(0, abs=1e-9)
    assert exact.patches == [] and exact.bands[0].share == 1


@pytest.mark.parametrize("bands", [(), 0, (0.1, -1), "wide", np.nan])
def test_other_limits_are_refused(bands):
    with pytest.raises(symsurf.InvalidParameter, match="allowed are numbers above 0"):
        symsurf.asymmetry(bumpy()[0], PLANE, bands=bands)


def test_the_command_line_fails_above_a_limit(tmp_path):
    symsurf.asymmetry(bumpy()[0], PLANE).save(tmp_path / "part.ply")
    line = "asymmetry part.ply --mirror x=0 --bands 0.012,0.1 --fail-above"
    failed = run_here(f"{line} 0.04", tmp_path)
    assert failed.returncode == 3
    assert "the largest distance is 0.04" in failed.stderr and "patch 6" in failed.stdout
    passed = run_here(f"{line} 0.06 --json", tmp_path)
    assert passed.returncode == 0 and passed.stderr == ""
    record = json.loads(passed.stdout)
    assert len(record["patches"]) == 6 and record["bands"][1]["share"] == 1
    page = run_here(f"{line} 0.06 -o part.html", tmp_path)
    assert page.returncode == 0, page.stderr
    text = (tmp_path / "part.html").read_text()
    assert "Tolerance bands" in text and "Over a plane that was given" in text
