"""Completion about an axis: pots, gears, and what is no axis."""

import json

import numpy as np
import pytest
from accuracy.pots import (
    added_error,
    broken_pot,
    cut,
    degrees_between,
    gear,
    left,
    left_open,
    posed,
)
from command_line import run_here
from seeds import each_seed

import symsurf


@pytest.mark.parametrize("kind", ["sheet", "walls", "sheet cloud", "walls cloud"])
@each_seed
def test_a_pot_is_completed_from_the_rest_of_its_turn(kind, seed):
    rng = np.random.default_rng([seed, 21])
    given, whole, axis = broken_pot(kind, rng.uniform(0.1, 0.65), rng)
    made = symsurf.complete(given, symmetry="axis")
    assert made.mirror is None
    assert made.axis.order == 0
    assert degrees_between(made.axis, axis) < 0.5
    assert added_error(made, whole) < 0.005
    assert left_open(made, whole) < 0.01
    count = len(given.points)
    np.testing.assert_array_equal(made.shape.points[:count], given.points)
    assert (made.origin[:count] == 0).all() and (made.origin[count:] > 0).all()
    assert made.sources.max() < count and len(made.sources) == len(made.shape.points)
    if given.faces is not None:
        assert made.face_sources.max() < len(given.faces)


@each_seed
def test_a_fifth_of_the_turn_tells_the_axis(seed):
    rng = np.random.default_rng([seed, 22])
    for kind in ("sheet", "walls"):
        given, _, axis = broken_pot(kind, 0.8, rng)
        found = symsurf.symmetries(given)
        assert found.group == "C∞v"
        assert degrees_between(found.axes[0], axis) < 0.5
        assert 0.7 < found.missing < 0.85


@pytest.mark.parametrize("teeth", [5, 7, 12])
def test_a_gear_is_completed_tooth_by_tooth(teeth):
    rng = np.random.default_rng(teeth)
    whole, axis = posed(*gear(teeth, rng), teeth, rng)
    given = cut(whole, left(whole, axis, 1 / 3, rng), 0, rng)
    for made in (
        symsurf.complete(given, axis),
        symsurf.complete(
            given,
            symmetry="axis",
            axis_point=axis.point,
            axis_direction=axis.direction,
            axis_order=teeth,
        ),
    ):
        assert made.axis.order == teeth
        assert added_error(made, whole) < 1e-3
        assert left_open(made, whole) == 0


def _area_vector_flux(shape):
    """Six times the signed volume between the faces and the middle."""
    a, b, c = ((shape.points - shape.points.mean(axis=0))[shape.faces[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", np.cross(a, b), c)


def test_turned_faces_keep_their_winding():
    rng = np.random.default_rng(3)
    given, whole, axis = broken_pot("sheet", 0.4, rng)
    made = symsurf.complete(given, symmetry=axis)
    ratio = _area_vector_flux(made.shape).sum() / _area_vector_flux(whole).sum()
    assert 0.97 < ratio < 1.03


def test_a_whole_pot_stays_as_it_is():
    rng = np.random.default_rng(4)
    given, _, axis = broken_pot("walls", 0.0, rng)
    made = symsurf.complete(given, symmetry=axis)
    assert made.statistics["added_points"] == 0
    assert made.statistics["turns"] == 0


def test_what_is_no_axis_is_refused():
    rng = np.random.default_rng(5)
    given, _, axis = broken_pot("sheet", 0.3, rng)
    far = axis.point + 1e3 * np.linalg.norm(given.points) * np.cross(axis.direction, (0.6, 0, 0.8))
    for error, message, options in (
        (symsurf.InvalidParameter, "axis_order is 1", {"symmetry": symsurf.Axis(axis.point, axis.direction, 1)}),
        (symsurf.InvalidParameter, "axis_order is -2", {"symmetry": symsurf.Axis(axis.point, axis.direction, -2)}),
        (symsurf.InvalidParameter, "direction", {"symmetry": symsurf.Axis(axis.point, (0, 0, 0))}),
        (symsurf.InvalidParameter, "without axis_direction", {"symmetry": "axis", "axis_point": (1, 2, 3)}),
        (symsurf.InvalidParameter, "without axis_direction", {"symmetry": "axis", "axis_order": 3}),
        (symsurf.InvalidParameter, "axis_order is 5 beside the symmetry 'mirror'", {"axis_order": 5}),
        (symsurf.InvalidParameter, "symmetry is of type int", {"symmetry": 3}),
        (symsurf.InvalidParameter, "symmetry is turn", {"symmetry": "turn"}),
        (symsurf.InvalidInput, "diagonals away from this axis", {"symmetry": symsurf.Axis(far, axis.direction)}),
    ):  # fmt: skip
        with pytest.raises(error, match=message):
            symsurf.complete(given, **options)
    with pytest.raises(symsurf.InvalidParameter, match="both given"):
        symsurf.complete(given, symsurf.Plane((1, 0, 0), 0), symmetry=axis)
    lump = rng.normal(size=(300, 3)) @ np.diag((1, 2, 3))
    with pytest.raises(symsurf.InvalidInput, match="no rotation axis"):
        symsurf.complete(lump, symmetry="axis")


def test_a_mirror_given_as_the_symmetry_is_the_result():
    rng = np.random.default_rng(6)
    points = rng.normal(size=(500, 3))
    plane = symsurf.Plane((1, 0, 0), 0)
    one, other = symsurf.complete(points, plane), symsurf.complete(points, symmetry=plane)
    np.testing.assert_array_equal(one.shape.points, other.shape.points)


def test_the_command_line_completes_about_an_axis(tmp_path):
    rng = np.random.default_rng(7)
    given, _, axis = broken_pot("sheet", 0.4, rng)
    path = tmp_path / "pot.ply"
    given.to_pyvista().save(path)
    point, direction = (
        ",".join(map(repr, map(float, row))) for row in (axis.point, axis.direction)
    )
    for options in ([f"--axis-direction={direction}", f"--axis-point={point}"], []):
        line = " ".join(["complete pot.ply --symmetry axis --json", *options])
        done = run_here(line, tmp_path)
        record = json.loads(done.stdout)
        assert done.returncode == 0 and record["mirror"] is None
        assert record["statistics"]["axis_order"] == 0
        assert record["statistics"]["added_points"] > 0.3 * len(given.points)


def test_it_is_drawn_with_its_axis(tmp_path):
    rng = np.random.default_rng(8)
    given, _, axis = broken_pot("sheet", 0.4, rng)
    made = symsurf.complete(given, symmetry=axis)
    made.plot(tmp_path / "pot.png")
    assert (tmp_path / "pot.png").stat().st_size > 1000
    assert "mirror: none" in repr(made)
    made.save(tmp_path / "pot.json")
    assert json.loads((tmp_path / "pot.json").read_text())["mirror"] is None
