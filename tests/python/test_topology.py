"""Pairs by the triangles alone: of posed bodies, whatever moved, in every front end of Python."""

import numpy as np
import pytest
from accuracy.limbed import BODIES
from accuracy.topology import pose, symmetric_faces
from command_line import run_here

import symsurf

BODY = BODIES["person"]
FACES = symmetric_faces(BODY)
POSED = symsurf.Shape(pose(BODY, np.random.default_rng(0), 2), FACES)  # by up to 57 degrees
OVER = (-1, 1, 1)


def test_closest_points_lose_limbs_that_triangles_find():
    found = symsurf.correspondences(POSED, "x=0", pairing="topology")
    np.testing.assert_array_equal(found.index, BODY.mirrored)
    assert found.statistics["paired_share"] == 1 and found.statistics["mirror_maps"] == 1
    closest = symsurf.correspondences(POSED, "x=0")
    assert (closest.index == BODY.mirrored).mean() < 0.9


def test_quadrangles_may_be_divided_in_any_way():
    shape = symsurf.Shape(POSED.points, BODY.faces)  # no triangulation is mirrored as a whole
    found = symsurf.correspondences(shape, "x=0", pairing="topology")
    np.testing.assert_array_equal(found.index, BODY.mirrored)
    mesh = POSED.to_pyvista()
    mesh.points = POSED.points.astype(float)
    made = mesh.symmetry.symmetrize(mirror="x=0", side="positive", pairing="topology")
    np.testing.assert_allclose(made.points[BODY.mirrored] * OVER, made.points, atol=1e-6)


def test_one_arm_bent_is_both_arms_bent_or_none():
    is_paired = BODY.mirrored != np.arange(len(BODY.mirrored))
    for side, sign in (("positive", 1), ("negative", -1)):
        made = symsurf.symmetrize(POSED, "x=0", side=side, pairing="topology")
        given = is_paired & (sign * BODY.points[:, 0] > 0)
        np.testing.assert_array_equal(made.shape.points[given], POSED.points[given])
        np.testing.assert_array_equal(
            made.shape.points[BODY.mirrored[given]], POSED.points[given] * OVER
        )
        assert made.paired.all()
    weights = np.where(is_paired, np.maximum(BODY.points[:, 0], 0), 0)
    both = symsurf.transfer(weights, POSED, "x=0", pairing="topology")
    np.testing.assert_array_equal(both.values, np.maximum(weights, weights[BODY.mirrored]))


def test_the_command_line_pairs_by_topology(tmp_path):
    symsurf.symmetrize(POSED, "x=0", strength=0).save(tmp_path / "posed.ply")
    line = "correspondences posed.ply --mirror x=0 --pairing topology -o posed.mirror"
    done = run_here(line, tmp_path)
    assert done.returncode == 0, done.stderr
    rows = [line.split() for line in (tmp_path / "posed.mirror").read_text().splitlines()]
    np.testing.assert_array_equal([int(row[1]) for row in rows], BODY.mirrored)
    off = BODY.mirrored != np.arange(len(BODY.mirrored))
    sides = np.where(off, np.where(BODY.points[:, 0] > 0, "l", "r"), "m")
    np.testing.assert_array_equal([row[2] for row in rows], sides)


def test_what_has_no_map_is_named():
    faces = np.vstack([BODY.faces[::2], BODY.faces[1::2]])  # the halves of quadrangles lie apart
    with pytest.raises(symsurf.InvalidInput, match="the triangulation is not symmetric: 0 of 1642"):
        symsurf.correspondences(symsurf.Shape(BODY.points, faces), "x=0", pairing="topology")
    with pytest.raises(symsurf.InvalidInput, match="pairing topology needs faces"):
        symsurf.symmetrize(BODY.points, "x=0", pairing="topology")
    with pytest.raises(symsurf.InvalidInput, match="landmark pairs"):
        symsurf.correspondences(POSED, "x=0", pairing="topology", pairs=[(0, 1)])
