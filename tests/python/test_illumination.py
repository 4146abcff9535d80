"""Light that a mirror throws onto points: the operation illuminate, from Python and by the command line."""

import json

import numpy as np
import pytest
from command_line import run_here

import symsurf

pyvista = pytest.importorskip("pyvista")

LIGHT = (0.3, 0.1, 1.5)
BALL = {"kind": "sphere", "centre": [0, 0, 2], "radius": 2}
SPHERE = symsurf.Sphere(BALL["centre"], BALL["radius"])


@pytest.fixture
def screen():
    return pyvista.Plane(center=(0, 0, 1), i_resolution=20, j_resolution=20).triangulate()


def test_sums_the_paths_that_reach_each_point(screen):
    points = np.asarray(screen.points, float)
    found = SPHERE.reflection_points(points, LIGHT)
    lit = symsurf.illuminate(points, SPHERE, light=LIGHT)
    np.testing.assert_array_equal(lit.paths, np.bincount(found.sources))
    np.testing.assert_allclose(lit.irradiance, np.bincount(found.sources, found.irradiance))
    first = np.unique(found.sources, return_index=True)[1]
    np.testing.assert_array_equal(lit.reflection, found.positions[first])
    # A mesh has a surface, which the light meets at an angle.
    ways = found.positions - points[found.sources]
    cosine = np.abs(ways[:, 2]) / np.linalg.norm(ways, axis=1)
    expected = np.bincount(found.sources, cosine * found.irradiance)
    np.testing.assert_allclose(symsurf.illuminate(screen, SPHERE, light=LIGHT).irradiance, expected)


def test_the_screen_is_no_footprint_of_the_mirror():
    nodes = np.array(
        [(x, y, 0.1 * x * y) for x in np.linspace(-2, 2, 9) for y in np.linspace(-2, 2, 9)]
    )
    mirror = symsurf.make_mirror("height field", {"direction": (0, 0, 1.0), "nodes": nodes})
    small = np.random.default_rng(0).uniform(-0.01, 0.01, size=(20, 3)) + (1, 1, 3)
    lit = symsurf.illuminate(small, mirror, light=(-1, -1, 3))
    assert lit.mirror.footprint is None and lit.statistics["lit_share"] == 1


def test_the_mirror_of_a_file_is_taken(screen, tmp_path):
    screen.save(tmp_path / "screen.ply")
    (tmp_path / "ball.json").write_text(json.dumps({"mirror": BALL}))
    line = "illuminate screen.ply --mirror ball.json --light 0.3,0.1,1.5"
    done = run_here(f"{line} --json --output made --format vtp", tmp_path)
    assert done.returncode == 0, done.stderr
    expected = symsurf.illuminate(tmp_path / "screen.ply", SPHERE, light=LIGHT)
    record = json.loads(done.stdout)
    assert (
        record["mirror"] | BALL == record["mirror"] and record["statistics"] == expected.statistics
    )
    made = pyvista.read(tmp_path / "made" / "screen.vtp")
    for name, values in expected.arrays.items():
        np.testing.assert_array_equal(made[name], values)
    assert "sphere, given" in run_here(line, tmp_path).stdout
    # What detect has written, and what is no mirror.
    run_here("detect screen.ply --method plane --output found", tmp_path)
    done = run_here("asymmetry screen.ply --mirror found/screen.summary.json", tmp_path)
    assert done.returncode == 0 and "plane, given" in done.stdout
    (tmp_path / "none.json").write_text('{"mirror": null}')
    for name in ("none.json", "missing.json"):
        done = run_here(f"illuminate screen.ply --mirror {name}", tmp_path)
        assert done.returncode == 2 and done.stderr.startswith(f"symsurf: {name}: ")


def test_meshes_of_pyvista_take_the_mirror_as_well(screen):
    made = screen.symmetry.illuminate(mirror=SPHERE, light=LIGHT)
    expected = symsurf.illuminate(screen, SPHERE, light=LIGHT)
    np.testing.assert_array_equal(made["irradiance"], expected.irradiance)
