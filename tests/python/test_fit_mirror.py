"""Mirrors through points that were drawn, and at the end of the thesis's methods."""

import numpy as np
import pytest
from symmetric_shapes import mirrored_surface

import symsurf

RNG = np.random.default_rng(11)
SHEET = RNG.uniform(-1, 1, size=(300, 3)) * (1, 1, 0)


def test_an_array_a_mesh_a_file_and_a_result_are_read(tmp_path):
    expected = symsurf.fit_mirror(SHEET)
    assert expected.kind == "plane"
    np.testing.assert_allclose(np.abs(expected.normal), (0, 0, 1), atol=1e-12)
    mesh = symsurf.Shape(SHEET, [[0, 1, 2]])
    np.savetxt(tmp_path / "sheet.xyz", SHEET)
    for given in (SHEET.tolist(), mesh, tmp_path / "sheet.xyz"):
        assert symsurf.fit_mirror(given) == expected


@pytest.mark.parametrize("method", ["separation", "separation_normals", "normals_only"])
def test_the_methods_of_the_thesis_end_with_a_mirror(method):
    points, _ = mirrored_surface(400, 1)
    found = symsurf.detect(points, method)
    expected = symsurf.fit_mirror(found)
    np.testing.assert_allclose(found.mirror.reflect(points), expected.reflect(points), atol=1e-9)
    assert symsurf.asymmetry(points, found).distance.shape == (len(points),)


def test_a_direction_makes_it_oblique():
    mirror = symsurf.fit_mirror(SHEET, "plane", direction=(1, 0, 1))
    assert isinstance(mirror, symsurf.ObliquePlane)
    assert mirror.obliquity == pytest.approx(45)
    with pytest.raises(symsurf.InvalidInput, match="direction that leaves it"):
        symsurf.fit_mirror(SHEET, "plane", direction=(1, 0, 0))


def test_straightening_gives_the_affine_map():
    body = RNG.normal(size=(200, 3))
    body = np.vstack([body, body * (-1, 1, 1)])
    sheared = body + 0.3 * body[:, :1] * (0, 1, 0)
    mirror = symsurf.ObliquePlane((1, 0, 0), 0, (1, 0.3, 0))
    straight = symsurf.straighten(sheared, mirror)
    np.testing.assert_allclose(
        np.column_stack([sheared, np.ones(400)]) @ straight.matrix[:3].T, straight.shape.points
    )
    back = symsurf.straighten(straight.shape, mirror, back=True)
    np.testing.assert_allclose(back.matrix @ straight.matrix, np.eye(4), atol=1e-12)
    assert symsurf.straighten(body, "x=0").matrix is None
