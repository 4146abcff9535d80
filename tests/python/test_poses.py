"""Poses of symmetric objects: the nearest of the equivalent ones, and the tables of pose estimators."""

from __future__ import annotations

import json

import numpy as np
import pytest
from accuracy.symmetric_parts import PARTS, box, extruded, polygon, turned
from command_line import run
from numpy.typing import NDArray
from symmetric_shapes import random_rotation

import symsurf

Array = NDArray[np.float64]


def found_of(triangles: Array) -> symsurf.Symmetries:
    corners, faces = np.unique(triangles.reshape(-1, 3).round(9), axis=0, return_inverse=True)
    return symsurf.symmetries(corners, faces=faces.reshape(-1, 3))


@pytest.fixture(scope="module")
def block() -> symsurf.Symmetries:
    """A box, away from the origin."""
    return found_of(box(2, 1.4, 0.9) + (3, -1, 2))


@pytest.fixture(scope="module")
def nut() -> symsurf.Symmetries:
    return found_of(PARTS["hexagonal nut"].triangles)


@pytest.fixture(scope="module")
def can() -> symsurf.Symmetries:
    """A cylinder about a line beside the origin, along y."""
    along_z = turned([0, 0.5, 0.5, 0], [-0.8, -0.8, 0.8, 0.8])
    return found_of(along_z[..., [0, 2, 1]] + (1, 0, 4))


@pytest.fixture(scope="module")
def cone() -> symsurf.Symmetries:
    return found_of(turned([0, 0.8, 0], [0, 0, 1.6]) + (0.5, 0.5, 0))


@pytest.fixture(scope="module")
def ball() -> symsurf.Symmetries:
    return found_of(PARTS["sphere"].triangles + (1, 2, 3))


def random_pose(rng: np.random.Generator) -> Array:
    pose = np.eye(4)
    pose[:3, :3] = random_rotation(rng)
    pose[:3, 3] = rng.normal(size=3)
    return pose


def angle_between(one: Array, other: Array) -> float:
    """Degrees, from the chord, which small angles do not round away."""
    chord = np.linalg.norm(one[:3, :3] - other[:3, :3])
    return float(np.degrees(2 * np.arcsin(min(1, chord / np.sqrt(8)))))


def rotations_of(found: symsurf.Symmetries) -> Array:
    return found.elements[np.linalg.det(found.elements[:, :3, :3]) > 0]


def about(axis: symsurf.Axis, angle: float) -> Array:
    """A turn by radians, made by reflecting in two planes that hold the axis."""
    across = np.linalg.svd(axis.direction[None])[2][1:]

    def reflection(turned: float) -> Array:
        normal = across.T @ (np.cos(turned), np.sin(turned))
        matrix = np.eye(4)
        matrix[:3, :3] -= 2 * np.outer(normal, normal)
        matrix[:3, 3] = 2 * normal * (normal @ axis.point)
        return matrix

    return reflection(angle / 2) @ reflection(0)


@pytest.mark.parametrize("name", ["block", "nut"])
def test_nearest_is_the_best_of_all_rotations(name, request):
    found = request.getfixturevalue(name)
    rng = np.random.default_rng(0)
    for _ in range(20):
        pose, to = random_pose(rng), random_pose(rng)
        equivalent = pose @ rotations_of(found)
        nearest = found.nearest(pose, to)
        gaps = np.abs(equivalent - nearest).max(axis=(1, 2))
        assert gaps.min() < 1e-12
        angles = [angle_between(each, to) for each in equivalent]
        assert angles[gaps.argmin()] == pytest.approx(min(angles), abs=1e-6)


@pytest.mark.parametrize("name", ["can", "cone"])
def test_the_angle_about_a_continuous_axis_is_the_best(name, request):
    found = request.getfixturevalue(name)
    (axis,) = (each for each in found.axes if each.continuous)
    turns = np.array([about(axis, angle) for angle in np.radians(np.arange(0, 360, 0.5))])
    turns = (turns[:, None] @ rotations_of(found)[None]).reshape(-1, 4, 4)
    rng = np.random.default_rng(1)
    for _ in range(10):
        pose, to = random_pose(rng), random_pose(rng)
        nearest = found.nearest(pose, to)
        best = min(angle_between(pose @ turn, to) for turn in turns)
        assert angle_between(nearest, to) <= best + 1e-9
        element = np.linalg.inv(pose) @ nearest
        assert element @ [*found.centre, 1] == pytest.approx([*found.centre, 1])
        assert abs(element[:3, :3] @ axis.direction @ axis.direction) == pytest.approx(1)


def test_of_a_ball_no_rotation_is_left(ball):
    rng = np.random.default_rng(2)
    pose, to = random_pose(rng), random_pose(rng)
    nearest = ball.nearest(pose, to)
    assert nearest[:3, :3] == pytest.approx(to[:3, :3])
    centre = [*ball.centre, 1]
    assert nearest @ centre == pytest.approx(pose @ centre)


@pytest.mark.parametrize("name", ["block", "nut", "can", "cone", "ball"])
def test_equivalent_poses_have_the_same_nearest_one(name, request):
    found = request.getfixturevalue(name)
    rng = np.random.default_rng(3)
    pose, to = random_pose(rng), random_pose(rng)
    for turn in rotations_of(found):
        assert found.nearest(pose @ turn, to) == pytest.approx(found.nearest(pose, to), abs=1e-9)
    poses, others = np.array([random_pose(rng) for _ in range(6)]).reshape(2, 3, 4, 4)
    one_by_one = [found.nearest(pose, to) for pose, to in zip(poses, others)]
    assert found.nearest(poses, others) == pytest.approx(np.array(one_by_one), abs=1e-12)
    same = found.nearest(poses, to)
    assert same == pytest.approx(np.array([found.nearest(pose, to) for pose in poses]), abs=1e-12)


@pytest.mark.parametrize("name", ["block", "nut", "can"])
def test_what_a_tracker_gives_jumps_no_more(name, request):
    """Along a path by steps of less than half the least turn, from an equivalent pose at each."""
    found = request.getfixturevalue(name)
    rng = np.random.default_rng(4)
    step = random_pose(rng)
    axis = symsurf.Axis(np.zeros(3), step[:3, 0], 0, np.zeros((2, 3)))
    path = np.array([step @ about(axis, np.radians(7 * k)) for k in range(40)])
    turns = rotations_of(found)
    given = np.array([pose @ turns[rng.integers(len(turns))] for pose in path])
    given[0] = path[0]
    steady = found.nearest(given)
    assert max(map(angle_between, steady[1:], steady[:-1])) < 7 + 1e-6
    if name != "can":  # about its own axis a can may lie anyhow
        assert steady == pytest.approx(path, abs=1e-9)


def test_poses_that_are_not_rigid_are_named(block):
    good = np.eye(4)
    mirrored, scaled, wrong_row = np.diag([1.0, 1, -1, 1]), np.diag([2.0, 2, 2, 1]), np.eye(4)
    wrong_row[3, 0] = 0.5
    for pose, message in (
        (mirrored, "pose is a reflection"),
        (scaled, "pose is not rigid: .* by 3;"),
        (wrong_row, r"pose ends with the row \[0.5, 0.0, 0.0, 1.0\]"),
        (np.full((4, 4), np.nan), "pose has a number that is not finite"),
        (np.eye(3), r"pose has shape \(3, 3\); allowed is \(4, 4\) or \(k, 4, 4\)"),
        ([good, scaled], r"pose\[1\] is not rigid"),
        ("here", "pose holds no numbers"),
    ):
        with pytest.raises(symsurf.InvalidInput, match=message):
            block.nearest(pose, good)
    with pytest.raises(symsurf.InvalidInput, match="to is a reflection"):
        block.nearest(good, mirrored)
    with pytest.raises(symsurf.InvalidInput, match="to has 3 poses, pose 2; allowed is one, or as"):
        block.nearest([good] * 2, [good] * 3)
    with pytest.raises(symsurf.InvalidInput, match="to is None and pose is one"):
        block.nearest(good)


def test_bop_takes_what_deviates_little():
    """A box with a low step on one side: some half turns take it off itself, others do not."""
    step = box(2, 1.4, 0.04) + (0, 0, 0.47)
    found = found_of(np.concatenate([box(2, 1.4, 0.9), step]))
    assert found.to_bop(tolerance=10) == found.to_bop()
    entry = found.to_bop(tolerance=1e-6)
    listed = dict(zip(map(tuple, found.to_bop()["symmetries_discrete"]), found.max_deviation[1:]))
    kept = [list(matrix) for matrix in listed if listed[matrix] <= 1e-6]
    assert entry.get("symmetries_discrete", []) == kept
    for tolerance in (-1, np.nan, np.inf):
        with pytest.raises(
            symsurf.InvalidParameter, match=r"tolerance is .*; allowed is \[0, inf\)"
        ):
            found.to_bop(tolerance)


def test_bop_leaves_out_continuous_axes_that_deviate_more():
    """A prism of 40 sides goes for a round body; between its edges it is not."""
    prism = found_of(extruded(polygon(40), 3.0))
    sagitta = 1 - np.cos(np.pi / 40)
    if prism.group == "D∞h":
        assert prism.axis_max_deviation == pytest.approx([sagitta], rel=0.2)
        assert "symmetries_continuous" in prism.to_bop(2 * sagitta)
        assert "symmetries_continuous" not in prism.to_bop(sagitta / 10)
    else:
        assert prism.group == "D40h" and len(prism.axis_max_deviation) == 0


def test_foundationpose_gets_every_rotation(block, can, ball):
    assert block.to_foundationpose() == pytest.approx(rotations_of(block))
    for found, step, count in ((can, 5.0, 2 * 72), (can, 7.0, 2 * 52), (ball, 5.0, 12 * 7 * 12)):
        matrices = found.to_foundationpose(step)
        assert matrices.shape == (count, 4, 4)
        assert matrices[0] == pytest.approx(np.eye(4))
        assert np.linalg.det(matrices[:, :3, :3]) == pytest.approx(np.ones(count))
        centre = [*found.centre, 1]
        assert matrices @ centre == pytest.approx(np.tile(centre, (count, 1)))
    (axis, *_) = can.axes
    assert (
        np.abs(can.to_foundationpose()[:, :3, :3] @ axis.direction @ axis.direction).min() > 0.999
    )
    for step in (0, 181, np.nan):
        with pytest.raises(symsurf.InvalidParameter, match="step is .*; allowed is above 0"):
            can.to_foundationpose(step)


def isaac_rotations(names: list[str]) -> Array:
    """As Isaac makes them of its parameter: all products of a turn about z, y and x."""
    angles: dict[str, list[float]] = {"z": [0], "y": [0], "x": [0]}
    for axis, _, angle in (name.partition("_") for name in names):
        angles[axis] += range(0, 360, 30) if angle == "full" else [float(angle)]
    basis = dict(zip("xyz", np.eye(3)))
    about_each = [
        [
            about(symsurf.Axis(np.zeros(3), basis[axis], 0, None), np.radians(a))[:3, :3]
            for a in each
        ]
        for axis, each in angles.items()
    ]
    return np.array(
        [z @ y @ x for z in about_each[0] for y in about_each[1] for x in about_each[2]]
    )


def test_isaac_makes_the_rotations_of_the_names(block, nut, can, cone, ball):
    assert block.to_isaac() == {"symmetry_axes": ["x_180", "y_180", "z_180"]}
    assert can.to_isaac() == {"symmetry_axes": ["y_full", "x_180"]}
    assert cone.to_isaac() == {"symmetry_axes": ["z_full"]}
    assert sorted(ball.to_isaac()["symmetry_axes"]) == ["x_full", "y_full", "z_full"]
    names = nut.to_isaac()["symmetry_axes"]
    assert {"z_60", "z_120", "z_180", "z_240", "z_300"} < set(names)
    made, own = isaac_rotations(names), rotations_of(nut)[:, :3, :3]
    gaps = np.abs(made[:, None] - own[None]).max(axis=(2, 3))
    within = 2e-3  # what the pose of the group is fitted to
    assert gaps.min(axis=1).max() < within and gaps.min(axis=0).max() < within


def test_isaac_has_no_name_for_oblique_axes():
    oblique = found_of(box(2, 1.4, 0.9) @ random_rotation(np.random.default_rng(5)).T)
    with pytest.warns(symsurf.InputWarning, match="3 rotations are no products of those about x"):
        assert oblique.to_isaac() == {"symmetry_axes": []}


def test_the_command_line_prints_isaacs_parameter(tmp_path, block):
    path = tmp_path / "block.off"
    shape = block.shape
    rows = [
        *map(" ".join, shape.points.astype(str)),
        *(f"3 {a} {b} {c}" for a, b, c in shape.faces),
    ]
    path.write_text(f"OFF\n{len(shape.points)} {len(shape.faces)} 0\n" + "\n".join(rows) + "\n")
    assert json.loads(run("symmetries", path, "--isaac").stdout) == {str(path): block.to_isaac()}
    both = run("symmetries", path, "--isaac", "--json")
    assert both.returncode == 2 and "json is given beside isaac" in both.stderr
