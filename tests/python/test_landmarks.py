"""Landmarks: reading their files, pairing them, the plane that they say, and the other side."""

from __future__ import annotations

import gzip
import itertools
import json
from dataclasses import replace

import numpy as np
import pytest
from symmetric_shapes import mirrored_surface, random_rotation

import symsurf
from symsurf.morphometrics.assignment import assignment

POINTS = np.array([[1.25, -2, 3e-3], [4.5, 5, -6], [0, 7.125, 8]])
NAMES = ("eye_L", "eye_R", "nasion")


def markups(**fields):
    points = [
        {"id": str(i), "label": name, "position": row, "positionStatus": "defined"}
        for i, (name, row) in enumerate(zip(NAMES, POINTS.tolist()), 1)
    ]
    return {"markups": [{"type": "Fiducial", "controlPoints": points, **fields}]}


def rows(joint=" ", names=None):
    lines = [joint.join(map(repr, row)) for row in POINTS.tolist()]
    if names:
        lines = [f"{name}{joint}{line}" for name, line in zip(names, lines)]
    return "\n".join(lines) + "\n"


FCSV = "# Markups fiducial file version = 4.11\n# CoordinateSystem = {}\n# columns = {}\n"
NEW_COLUMNS = "id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID"
NEW_ROWS = "".join(
    f"vtkMRMLMarkupsFiducialNode_{i},{','.join(map(repr, row))},0,0,0,1,1,1,0,{name},,,2,0\n"
    for i, (name, row) in enumerate(zip(NAMES, POINTS.tolist()))
)
OLD = "# name = skull\n# numPoints = 3\n# columns = label,x,y,z,sel,vis\n"
OLD_ROWS = "".join(
    f"{name},{','.join(map(repr, row))},1,1\n" for name, row in zip(NAMES, POINTS.tolist())
)
DECIMAL_COMMAS = rows(";", NAMES).replace(".", ",")
NUMBERED = tuple("012")
S_NAMES = ("S000", "S001", "C000")

# Of each file its content, and the names and the axes that are read of it.
FILES = {
    "a.mrk.json": (json.dumps(markups(coordinateSystem="LPS")), NAMES, "LPS"),
    "b.mrk.json": (json.dumps(markups(coordinateSystem="RAS")), NAMES, "RAS"),
    "c.mrk.json": (json.dumps(markups(coordinateSystem="1")), NAMES, "LPS"),
    "d.mrk.json": (json.dumps(markups()), NAMES, ""),
    "new.fcsv": (FCSV.format("LPS", NEW_COLUMNS) + NEW_ROWS, NAMES, "LPS"),
    "numbered.fcsv": (FCSV.format("0", NEW_COLUMNS) + NEW_ROWS, NAMES, "RAS"),
    "one.fcsv": (FCSV.format("1", NEW_COLUMNS) + NEW_ROWS, NAMES, "LPS"),
    "old.fcsv": (OLD + OLD_ROWS, NAMES, ""),
    "bare.fcsv": (OLD_ROWS, NAMES, ""),
    "a.tps": (f"LM3=3\n{rows()}ID=skull_1\n", (), ""),
    "small.tps": (f"lm3 = 3\r\n{rows()}".replace("\n", "\r\n"), (), ""),
    "curves.tps": (f"LM=3\n{rows()}CURVES=1\nPOINTS=2\n1 2 3\n4 5 6\nIMAGE=a.jpg\n", (), ""),
    "landmark.pts": (f"Version 1.0\n3\n{rows(names=S_NAMES)}", S_NAMES, ""),
    "plain.pts": (rows(), (), ""),
    "counted.pts": (f"3\n{rows()}", (), ""),
    "named.pts": (rows(names=NAMES), NAMES, ""),
    "braces.pts": (f"version: 1\nn_points:  3\n{{\n{rows()}}}\n", (), ""),
    "a.csv": (f"name,x,y,z\n{rows(',', NAMES)}", NAMES, ""),
    "bare.csv": (rows(",", NAMES), NAMES, ""),
    "plain.csv": (rows(","), (), ""),
    "units.csv": (f"\ufeffLabel, X [mm], Y [mm], Z [mm]\n{rows(',', NAMES)}", NAMES, ""),
    "commas.csv": (f"name;x;y;z\n{DECIMAL_COMMAS}", NAMES, ""),
    "tabs.csv": (f"# made by hand\nx\ty\tz\n{rows(chr(9))}", (), ""),
    "ids.csv": (rows(",", NUMBERED), NUMBERED, ""),
}


def written(folder, name, content):
    path = folder / name
    path.write_text(content, newline="")
    return path


@pytest.mark.parametrize("name", FILES)
def test_landmarks_are_read(name, tmp_path):
    content, names, space = FILES[name]
    found = symsurf.read_landmarks(written(tmp_path, name, content))
    np.testing.assert_array_equal(found.points, POINTS)
    assert found.names == names and found.space == space
    assert repr(found).startswith("Landmarks(3 landmarks")
    packed = tmp_path / f"{name}.gz"
    packed.write_bytes(gzip.compress(content.encode()))
    np.testing.assert_array_equal(symsurf.read_landmarks(str(packed)).points, POINTS)


def test_tps_of_several_specimens(tmp_path):
    flat = "LM=2\n1 2\n3 4\nIMAGE=C:\\pictures\\first.jpg\nID=7\nSCALE=0.5\n"
    path = written(tmp_path, "all.tps", f"{flat}\nLM=2\n5 6\nNA NA\nIMAGE=second.jpg\n")
    first, second = symsurf.read_landmark_sets(path)
    np.testing.assert_array_equal(first.points, [[0.5, 1], [1.5, 2]])
    np.testing.assert_array_equal(second.points, [[5, 6], [np.nan, np.nan]])
    assert (first.specimen, first.image) == ("7", "C:\\pictures\\first.jpg")
    assert (second.specimen, second.image) == ("second", "second.jpg")
    with pytest.raises(symsurf.InvalidInput, match=r"all\.tps.*2 specimens.*read_landmark_sets"):
        symsurf.read_landmarks(path)


def test_missing_landmarks_are_nan(tmp_path):
    placed = markups()
    placed["markups"][0]["controlPoints"][1] |= {"positionStatus": "undefined"}
    contents = {
        "a.mrk.json": json.dumps(placed),
        "a.pts": f"Version 1.0\n3\n{rows(names=S_NAMES)}".replace(
            "4.5 5.0 -6.0", "9999.0 9999.0 9999.0"
        ),
        "a.csv": f"name,x,y,z\n{rows(',', NAMES)}".replace("4.5,5.0,-6.0", "NA,,nan"),
    }
    for name, content in contents.items():
        points = symsurf.read_landmarks(written(tmp_path, name, content)).points
        np.testing.assert_array_equal(np.isnan(points).all(axis=1), [False, True, False])


BROKEN = {
    "a.xyz": ("1 2 3\n", "suffix '.xyz' is none of .mrk.json .fcsv .tps .pts .csv"),
    "a.json": ('{"markups": 3}', "no list of points of 3D Slicer"),
    "b.json": ("{", "broken"),
    "c.json": ('{"markups": []}', "no landmarks"),
    "a.tps": ("LM3=3\n1 2 3\n4 5 6\n", "2 landmarks follow; it promises 3"),
    "b.tps": ("1 2 3\n", "no line LM= or LM3="),
    "c.tps": ("LM=2\n1 2\n3 4 5\n", "line 3: there are 3 coordinates"),
    "d.tps": ("LM=1\n1 2\nSCALE=big\n", "line 3: 'big' is no number"),
    "e.tps": ("LM=many\n1 2\n", "'many' is no number of landmarks"),
    "a.pts": ("Version 1.0\n5\n1 2 3\n", "there are 1 landmarks; the file promises 5"),
    "b.pts": ("1 2 3 0.5\n4 5 6 0.25\n", "line 1: there are four numbers"),
    "a.csv": ("name,x,y,z\na,1,2\n", "line 2: there are 3 columns"),
    "b.csv": ("name,x,y,z\na,1,2,three\n", "line 2: 'three' is no number"),
    "c.csv": ("name,x,y,z\n", "no landmarks"),
    "d.csv": ("name,east,north\na,1,2\n", "'east' is no number"),
    "a.fcsv": ("# columns = label,r,a,s\nF,1,2,3\n", "allowed are some with x and y"),
    "empty.csv": ("", "the file is empty"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_files_are_named(name, tmp_path):
    content, reason = BROKEN[name]
    with pytest.raises(symsurf.InvalidInput) as error:
        symsurf.read_landmarks(written(tmp_path, name, content))
    assert name in str(error.value) and reason in str(error.value)


def test_what_is_no_file(tmp_path):
    with pytest.raises(symsurf.InvalidInput, match=r"none\.tps.*no such file"):
        symsurf.read_landmarks(tmp_path / "none.tps")
    with pytest.raises(symsurf.InvalidInput, match="allowed is the name of a file"):
        symsurf.read_landmarks(3)
    path = tmp_path / "latin.csv"
    path.write_bytes(b"name,x,y,z\n\xe9,1,2,3\n")
    with pytest.raises(symsurf.InvalidInput, match=r"latin\.csv: broken"):
        symsurf.read_landmarks(path)


@pytest.mark.parametrize("count", range(1, 7))
def test_assignments_cost_least(count, rng):
    for _ in range(20):
        costs = rng.integers(0, 5, (count, count)).astype(float)  # with many ties
        found = assignment(costs)
        assert sorted(found) == list(range(count))
        least = min(
            sum(costs[row, column] for row, column in enumerate(order))
            for order in itertools.permutations(range(count))
        )
        assert costs[np.arange(count), found].sum() == least


def symmetric_landmarks(rng, pairs=20, midline=5):
    """Landmarks in any pose and order, their plane, and which are pairs and on the midline."""
    left = rng.normal(size=(pairs, 3)) + (3, 0, 0)
    middle = rng.normal(size=(midline, 3)) * (0, 1, 1)
    points = np.concatenate([left, left * (-1, 1, 1), middle])
    rotation, shift = random_rotation(rng), rng.normal(size=3)
    plane = symsurf.Plane(rotation[:, 0], -rotation[:, 0] @ shift)
    order = rng.permutation(len(points))
    place = np.argsort(order)
    both = np.sort(np.column_stack([place[:pairs], place[pairs : 2 * pairs]]), axis=1)
    return (points @ rotation.T + shift)[order], plane, as_set(both), set(place[2 * pairs :])


def as_set(pairs):
    return {tuple(sorted(map(int, pair))) for pair in pairs}


def test_pairs_by_position(rng):
    for _ in range(10):
        points, plane, pairs, midline = symmetric_landmarks(rng)
        noisy = points + 0.01 * rng.normal(size=points.shape)
        for given in (points, noisy):
            found = symsurf.landmark_pairs(given, plane)
            assert as_set(found.pairs) == pairs and set(found.midline) == midline
            assert len(found.odd) == 0 and found.odd_names == ()


def test_landmarks_without_a_counterpart_are_odd(rng):
    points, plane, pairs, midline = symmetric_landmarks(rng)
    lone, partner = min(pairs)
    kept = np.delete(np.arange(len(points)), partner)
    names = [f"landmark {chr(65 + i)}x" for i in kept]
    found = symsurf.landmark_pairs(points[kept], plane, names)
    assert kept[found.odd].tolist() == [lone] and found.odd_names == (
        f"landmark {chr(65 + lone)}x",
    )
    assert as_set(kept[found.pairs]) == pairs - {(lone, partner)}
    assert set(kept[found.midline]) == midline


SIDES = [
    ("l_eye", "r_eye"), ("eye_L", "eye_R"), ("left eye", "right eye"), ("eye.L", "eye.R"),
    ("eye-l", "eye-r"), ("eyeLeft", "eyeRight"), ("ala sinistra", "ala dextra"), ("ZyL", "ZyR"),
    ("LEFT_EYE", "RIGHT_EYE"), ("Eye Sinister", "Eye Dexter"), ("m1_left_2", "m1_right_2"),
]  # fmt: skip


@pytest.mark.parametrize("left, right", SIDES)
def test_pairs_by_name(left, right, rng):
    """Wherever the landmarks are; the others mirror themselves without a mirror."""
    found = symsurf.landmark_pairs(
        rng.normal(size=(4, 3)), None, ["nasion", right, left, "glabella"]
    )
    np.testing.assert_array_equal(found.pairs, [[2, 1]])
    np.testing.assert_array_equal(found.midline, [0, 3])


def test_names_say_some_and_places_the_others(rng):
    points, plane, pairs, midline = symmetric_landmarks(rng)
    first, second = min(pairs)
    names = [f"landmark {i}" for i in range(len(points))]
    names[first], names[second] = "eye_right", "eye_left"
    points[first] += 100  # where no place would say so
    landmarks = symsurf.Landmarks(points, tuple(names))
    found = symsurf.landmark_pairs(landmarks, plane, max_distance=0.01)
    assert found.pairs[0].tolist() == [second, first]
    assert as_set(found.pairs) == pairs and set(found.midline) == midline


def test_names_whose_other_side_is_missing(rng):
    points = rng.normal(size=(5, 3))
    names = ["l_eye", "r_eye", "l_ear", "nasion", "left tooth"]
    found = symsurf.landmark_pairs(points, None, names)
    assert found.odd_names == ("l_ear", "left tooth") and found.midline.tolist() == [3]
    assert "odd: l_ear, left tooth" in repr(found)
    with pytest.raises(symsurf.InvalidInput, match="no names tell left from right"):
        symsurf.landmark_pairs(points, None, ["L1", "L2", "L3", "L4", "L5"])


WRONG_PAIRS = [
    (["a", "b", "a"], "landmarks 0 and 2 are both called 'a'"),
    (["l_eye", "eye_L", "r_eye"], "'l_eye' and 'eye_L' both say left"),
    (["a", "b"], "2 names; allowed are 3"),
]


@pytest.mark.parametrize("names, reason", WRONG_PAIRS)
def test_names_that_clash(names, reason):
    with pytest.raises(symsurf.InvalidInput, match=reason):
        symsurf.landmark_pairs(POINTS, symsurf.Plane((1, 0, 0), 0), names)


def test_wrong_input_of_pairs():
    plane = symsurf.Plane((1, 0, 0), 0)
    missing = np.where(np.arange(3)[:, None] == 1, np.nan, POINTS)
    with pytest.raises(symsurf.InvalidInput, match="landmark 1 is missing"):
        symsurf.landmark_pairs(missing, plane)
    with pytest.raises(symsurf.InvalidInput, match=r"shape \(3, 2\)"):
        symsurf.landmark_pairs(POINTS[:, :2], plane)
    with pytest.raises(symsurf.InvalidParameter, match="max_distance is 0"):
        symsurf.landmark_pairs(POINTS, plane, max_distance=0)
    with pytest.raises(symsurf.InvalidInput, match="cannot be read"):
        symsurf.landmark_pairs([["a", "b", "c"]], plane)


def cost(plane, points, pairs, midline):
    ends = np.concatenate([pairs, pairs[:, ::-1], np.column_stack([midline, midline])])
    return ((plane.reflect(points[ends[:, 0]]) - points[ends[:, 1]]) ** 2).sum()


def test_plane_of_landmarks(rng):
    points, plane, pairs, midline = symmetric_landmarks(rng)
    both, alone = np.array(sorted(pairs)), np.array(sorted(midline))
    for given in ((both, alone), (both, ()), (both[:1], ()), (np.empty((0, 2), int), alone)):
        found = symsurf.plane_of_landmarks(points, *given)
        np.testing.assert_allclose(found.reflect(points), plane.reflect(points), atol=1e-9)
    paired = symsurf.landmark_pairs(points, plane)
    found = symsurf.plane_of_landmarks(symsurf.Landmarks(points), paired)
    np.testing.assert_allclose(found.reflect(points), plane.reflect(points), atol=1e-9)
    points[both[0, 0]] = np.nan  # its pair is left out
    found = symsurf.plane_of_landmarks(points, both, alone)
    np.testing.assert_allclose(found.reflect(points[1:]), plane.reflect(points[1:]), atol=1e-9)


def test_plane_of_landmarks_costs_least(rng):
    """No plane near it, or anywhere, maps the relabelled landmarks closer."""
    points, _, pairs, midline = symmetric_landmarks(rng)
    points += 0.3 * rng.normal(size=points.shape)
    both, alone = np.array(sorted(pairs)), np.array(sorted(midline))
    found = symsurf.plane_of_landmarks(points, both, alone)
    least = cost(found, points, both, alone)
    for size in (1e-3, 1e-1, 10):
        for _ in range(50):
            normal = found.normal + size * rng.normal(size=3)
            offset = (found.offset + size * rng.normal()) / np.linalg.norm(normal)
            other = symsurf.Plane(normal / np.linalg.norm(normal), offset)
            assert cost(other, points, both, alone) > least


def test_normals_of_landmarks_point_to_one_side():
    landmarks = np.array(
        [(31, 62, 10), (-29, 63, 11), (70, 5, 0), (-69, 4, 2), (0, 71, 9), (1, 55, -60)], float
    )
    for seed in range(20):
        placed = landmarks + np.random.default_rng(seed).normal(size=landmarks.shape)
        for pairs in ([(0, 1)], [(2, 3)], [(1, 0), (2, 3)]):
            assert symsurf.plane_of_landmarks(placed, pairs, [4, 5]).normal[0] > 0.9


def test_landmarks_that_leave_the_plane_open():
    for midline in ([0], [0, 1]):
        with pytest.raises(symsurf.InvalidInput, match="leave the plane open"):
            symsurf.plane_of_landmarks(POINTS, [], midline)
    with pytest.raises(symsurf.InvalidInput, match="no landmarks"):
        symsurf.plane_of_landmarks(POINTS, [])
    with pytest.raises(symsurf.InvalidInput, match="landmark 3; allowed are 0 to 2"):
        symsurf.plane_of_landmarks(POINTS, [[0, 3]])
    with pytest.raises(symsurf.InvalidInput, match="landmark 1 twice"):
        symsurf.plane_of_landmarks(POINTS, [[0, 1], [1, 2]])


def test_landmarks_on_the_other_side():
    """Of a body of which one side is deformed, along its surface too."""
    pyvista = pytest.importorskip("pyvista")
    ball = pyvista.Icosphere(radius=1, nsub=4)
    x = np.asarray(ball.points, dtype=float) * (1, 1.2, 0.8)
    plane = symsurf.Plane((1, 0, 0), 0)
    bent = x + np.where(x[:, :1] > 0, 0.05 * x[:, :1] * (0, 1, 0), 0)
    chosen = np.flatnonzero(x[:, 0] > 0.3)[::20]
    partner = [np.linalg.norm(x - plane.reflect(x[[i]]), axis=1).argmin() for i in chosen]
    carried = symsurf.carry_landmarks(bent[chosen], symsurf.Shape(bent, ball.regular_faces), plane)
    error = np.linalg.norm(carried - bent[partner], axis=1)
    slid = np.linalg.norm(plane.reflect(bent[chosen]) - bent[partner], axis=1)
    assert np.median(error) < 1e-6 and np.median(slid) > 0.01
    off = x[chosen] * 1.001  # beside the surface, and one that is missing
    off[0] = np.nan
    shape = symsurf.Shape(x, ball.regular_faces)
    carried = symsurf.carry_landmarks(symsurf.Landmarks(off), shape, plane)
    np.testing.assert_allclose(carried, plane.reflect(off), atol=1e-6)


def test_landmarks_on_the_other_side_of_a_cloud():
    points, plane = mirrored_surface(400, 0)
    carried = symsurf.carry_landmarks(points[:5], points, plane, pairing="closest")
    np.testing.assert_allclose(carried, plane.reflect(points[:5]), atol=1e-9)


def test_landmarks_are_data():
    landmarks = symsurf.Landmarks(POINTS, NAMES, "LPS")
    assert replace(landmarks, space="RAS").names == NAMES
    assert repr(landmarks) == "Landmarks(3 landmarks, LPS)"
