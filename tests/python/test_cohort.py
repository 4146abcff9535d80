"""Cohorts: their ANOVA against one by dummy variables, known asymmetry, and the command line."""

from __future__ import annotations

import csv
import itertools
import json

import numpy as np
import pytest
from command_line import run_here
from symmetric_shapes import mirrored_surface, random_rotation

import symsurf

PAIRS = np.array([[0, 6], [1, 7], [2, 8], [3, 9], [4, 10], [5, 11]])
MIDLINE = np.array([12, 13, 14])
COUNT = 15
ROWS = ["individual", "side", "individual_side", "error"]


def relabelled(shapes):
    order = np.arange(COUNT)
    order[PAIRS] = PAIRS[:, ::-1]
    return shapes[..., order, :]


def mirrored(shapes):
    """The same over x = 0, left and right relabelled."""
    return relabelled(shapes) * np.where(np.arange(shapes.shape[-1]) == 0, -1, 1)


def symmetric_shape(rng, d=3):
    shape = rng.normal(size=(COUNT, d))
    return (shape + mirrored(shape)) / 2


def sample(rng, n=8, r=2, da=0.0, fa=0.0, me=0.0, d=3):
    """Individuals with asymmetry of known sizes, in any pose and size each."""
    base = symmetric_shape(rng, d)
    common = da * antisymmetric(rng.normal(size=(COUNT, d)))
    own = fa * antisymmetric(rng.normal(size=(n, 1, COUNT, d)))
    kind = 0.1 * rng.normal(size=(n, 1, COUNT, d))
    shapes = base + (kind + mirrored(kind)) / 2 + common + own
    shapes = shapes + me * rng.normal(size=(n, r, COUNT, d))
    return moved(shapes, rng)


def antisymmetric(shapes):
    return (shapes - mirrored(shapes)) / 2


def moved(shapes, rng):
    made = shapes.copy()
    for place in np.ndindex(shapes.shape[:2]):
        rotation = random_rotation(rng)
        if shapes.shape[-1] == 2:
            c, s = np.cos(rng.uniform(0, 6)), np.sin(rng.uniform(0, 6))
            rotation = np.array([[c, -s], [s, c]]) / np.hypot(c, s)
        made[place] = np.exp(rng.normal()) * shapes[place] @ rotation + 10 * rng.normal(
            size=shapes.shape[-1]
        )
    return made


# An ANOVA of the definition: superimposed one by one, explained by columns of dummy variables.


def onto(reference, shape):
    u, _, vt = np.linalg.svd(shape.T @ reference)
    sign = np.eye(len(u))
    sign[-1, -1] = np.linalg.det(u @ vt)
    return shape @ u @ sign @ vt


def procrustes(shapes):
    shapes = [s - s.mean(axis=0) for s in shapes]
    shapes = [s / np.sqrt((s**2).sum()) for s in shapes]
    shapes = [onto(shapes[0], s) for s in shapes]
    spread = change = len(shapes) - sum(np.sum(np.mean(shapes, axis=0) * s) for s in shapes)
    rounds = 1
    while change > 1e-4 and rounds < 5:
        mean = np.mean(shapes, axis=0)
        shapes = [onto(mean, s) for s in shapes]
        now = len(shapes) - sum(np.sum(np.mean(shapes, axis=0) * s) for s in shapes)
        spread, change, rounds = now, abs(now - spread), rounds + 1
    flat = np.array(shapes).reshape(len(shapes), -1)
    pole = flat.mean(axis=0) / np.linalg.norm(flat.mean(axis=0))
    return (flat @ (np.eye(len(pole)) - np.outer(pole, pole)) + pole).reshape(np.shape(shapes))


def residual(columns, values):
    design = np.column_stack([np.ones(len(values)), *columns])
    left = values - design @ np.linalg.lstsq(design, values, rcond=None)[0]
    return (left**2).sum(), np.linalg.matrix_rank(design)


def brute_force(landmarks):
    """Sums of squares, degrees of freedom."""
    n, r = landmarks.shape[:2]
    first = procrustes(landmarks.reshape(n * r, *landmarks.shape[2:]))
    values = procrustes([*first, *mirrored(first)]).reshape(2 * n * r, -1)
    individual = np.tile(np.repeat(np.eye(n), r, axis=0), (2, 1))
    side = np.repeat(np.eye(2), n * r, axis=0)
    both = np.einsum("ai,aj->aij", individual, side).reshape(2 * n * r, -1)
    models = [(), (individual,), (individual, side), (individual, side, both)]
    left = [residual(model, values) for model in models] + [(0, 2 * n * r)]
    return [(a - b, q - p) for (a, p), (b, q) in itertools.pairwise(left)]


@pytest.mark.parametrize("replicates, d", [(1, 3), (2, 3), (3, 3), (2, 2)])
def test_anova_is_that_of_dummy_variables(replicates, d, rng):
    landmarks = sample(rng, r=replicates, da=0.05, fa=0.05, me=0.02, d=d)
    table = symsurf.cohort(landmarks, PAIRS, MIDLINE, permutations=9).table
    expected = brute_force(landmarks)
    assert list(table) == ROWS
    for row, (ss, df) in zip(table.values(), expected):
        assert row["df"] == df and row["ss"] == pytest.approx(ss, rel=1e-9, abs=1e-12)
    ms = [ss / df if df else np.nan for ss, df in expected]
    f = [ms[0] / ms[2], ms[1] / ms[2], ms[2] / ms[3], np.nan]
    for row, mean, ratio in zip(table.values(), ms, f):
        assert row["ms"] == pytest.approx(mean, rel=1e-9, nan_ok=True)
        assert row["F"] == pytest.approx(ratio, rel=1e-9, nan_ok=True)
        assert np.isnan(row["p"]) == np.isnan(ratio)


def test_one_replicate_needs_no_axis(rng):
    landmarks = sample(rng, r=1, fa=0.05)
    one, other = (symsurf.cohort(each, PAIRS) for each in (landmarks, landmarks[:, 0]))
    assert str(one.table) == str(other.table)
    assert one.table["individual_side"]["df"] == 7 and one.table["error"]["df"] == 0


def test_dimensions_of_shape_space(rng):
    """3 p + 2 m - 4 symmetric and 3 p + m - 3 asymmetric ones, flat 2 p + m - 2 of each."""
    for d, symmetric, asymmetric in ((3, 20, 18), (2, 13, 13)):
        table = symsurf.cohort(sample(rng, fa=0.1, me=0.1, d=d), PAIRS, permutations=0).table
        shape = [row["df_shape"] for row in table.values()]
        assert shape == [7 * symmetric, asymmetric, 7 * asymmetric, 16 * (symmetric + asymmetric)]


def test_pose_size_and_unit_do_not_matter(rng):
    landmarks = sample(rng, da=0.05, fa=0.05, me=0.02)
    one = symsurf.cohort(landmarks, PAIRS, permutations=99)
    other = symsurf.cohort(moved(landmarks, rng), PAIRS, permutations=99)
    for name in ROWS:
        assert list(one.table[name].values()) == pytest.approx(
            list(other.table[name].values()), rel=1e-9, nan_ok=True
        )
    np.testing.assert_allclose(one.magnitude, other.magnitude, rtol=1e-9)
    larger = symsurf.cohort(1000 * landmarks, PAIRS)
    np.testing.assert_allclose(larger.size, 1000 * one.size)


def test_left_and_right_may_change_places(rng):
    landmarks = sample(rng, da=0.05, fa=0.05, me=0.02)
    one, other = (symsurf.cohort(landmarks, pairs) for pairs in (PAIRS, PAIRS[::-1, ::-1]))
    for name in ROWS:
        assert one.table[name] == pytest.approx(other.table[name], rel=1e-9, nan_ok=True)


def test_components_make_up_the_shape(rng):
    """The symmetric one is symmetric over one plane for all, the asymmetric one antisymmetric; known
    asymmetry comes out."""
    landmarks = sample(rng, n=12, da=0.05, fa=0.02)
    found = symsurf.cohort(landmarks, PAIRS, MIDLINE)
    plane = symsurf.plane_of_landmarks(found.mean, PAIRS, MIDLINE)
    linear = plane.matrix[:3, :3]
    for shape in (found.mean, *found.symmetric):
        np.testing.assert_allclose(relabelled(plane.reflect(shape)), shape, atol=1e-4)
    np.testing.assert_allclose(relabelled(found.asymmetric @ linear), -found.asymmetric, atol=1e-4)
    np.testing.assert_allclose(found.symmetric.mean(axis=0), found.mean, atol=1e-12)
    np.testing.assert_allclose(found.directional + found.fluctuating, found.asymmetric, atol=1e-12)
    ratio = np.linalg.norm(found.directional) / np.linalg.norm(found.fluctuating, axis=(1, 2))
    assert 1.2 < np.median(ratio) < 5  # 2.5 as made, less what rotations take off each


def test_a_symmetric_cohort_has_no_asymmetry(rng):
    found = symsurf.cohort(sample(rng), PAIRS)
    assert found.magnitude.max() < 1e-9
    assert found.table["side"]["ss"] < 1e-18 and found.table["individual"]["ss"] > 0.01


def test_what_there_is_is_found(rng):
    """p says so of directional and of fluctuating asymmetry, where there is one."""
    kinds = {
        "side": sample(rng, n=15, da=0.03, fa=0.01, me=0.01),
        "individual_side": sample(rng, n=15, fa=0.03, me=0.005),
    }
    tables = {kind: symsurf.cohort(made, PAIRS).table for kind, made in kinds.items()}
    for kind, table in tables.items():
        assert table[kind]["p"] == 0.001 == table["individual"]["p"]


def test_p_is_even_where_there_is_nothing(rng):
    """Of cohorts without asymmetry but that of measurement, as many are below 0.2 as chance allows."""
    p = []
    for _ in range(60):
        table = symsurf.cohort(sample(rng, n=6, me=0.02), PAIRS, permutations=99).table
        p.append([table["side"]["p"], table["individual_side"]["p"]])
    below = (np.array(p) <= 0.2).sum(axis=0)
    assert (below >= 2).all() and (below <= 26).all()  # of 60 at 0.2, 12 +- 3.1: 4.5 deviations


def test_seeds_and_permutations(rng):
    landmarks = sample(rng, fa=0.005, me=0.02)
    one, same, other = (symsurf.cohort(landmarks, PAIRS, seed=seed) for seed in (1, 1, 2))
    assert str(one.table) == str(same.table)
    assert one.table["side"]["p"] == pytest.approx(other.table["side"]["p"], abs=0.1)
    assert np.isnan(symsurf.cohort(landmarks, PAIRS, permutations=0).table["side"]["p"])


def test_matching_symmetry(rng):
    """Organs of both sides, mirrored beforehand or not: as one object of both, but for how they lie."""
    organ = rng.normal(size=(COUNT, 3))
    own = 0.1 * rng.normal(size=(9, 1, COUNT, 3)) + 0.01 * rng.normal(size=(9, 2, COUNT, 3))
    left = organ + own
    right = organ + own + 0.05 * rng.normal(size=(COUNT, 3)) + 0.01 * rng.normal(size=own.shape)
    both = [right, right * (1, 1, -1)]
    one, other = (symsurf.cohort(moved(left, rng), other_side=moved(o, rng)) for o in both)
    values = procrustes([*left.reshape(-1, COUNT, 3), *right.reshape(-1, COUNT, 3)])
    sides = values.reshape(2, 9, 2, -1).mean(axis=(1, 2))
    assert one.table["side"]["ss"] == pytest.approx(
        9 * ((sides[0] - sides[1]) ** 2).sum(), rel=1e-9
    )
    for name in ROWS:
        assert one.table[name] == pytest.approx(other.table[name], rel=1e-9, nan_ok=True)
    assert one.table["side"]["p"] == 0.001 and one.table["side"]["df_shape"] == 3 * COUNT - 7
    with pytest.raises(symsurf.InvalidInput, match="other_side has shape"):
        symsurf.cohort(left, other_side=right[:, :1])


def test_percentiles(rng):
    landmarks = sample(rng, n=11, r=1, fa=0.01)[:, 0]
    landmarks[4, 3] += 0.5 * np.linalg.norm(landmarks[4].std(axis=0))
    found = symsurf.cohort(landmarks, PAIRS, permutations=0)
    assert found.percentile(4)[[3, 9]].tolist() == [100, 100]
    own = found.magnitude
    for individual in range(11):
        rank = [(np.delete(own[:, k], individual) < own[individual, k]).sum() for k in range(COUNT)]
        np.testing.assert_allclose(found.percentile(individual), 10 * np.array(rank))
    for wrong in (11, -1, 0.5):
        with pytest.raises(symsurf.InvalidParameter, match="allowed are 0 to 10"):
            found.percentile(wrong)


def test_what_cohorts_are_made_of(rng):
    landmarks = sample(rng, fa=0.1)
    expected = str(symsurf.cohort(landmarks, PAIRS).table)
    named = [[symsurf.Landmarks(points) for points in each] for each in landmarks]
    shapes = [[symsurf.Shape(points) for points in each] for each in landmarks]
    paired = symsurf.LandmarkPairs(PAIRS, MIDLINE, np.empty(0, int))
    for given in (landmarks.tolist(), list(landmarks), list(map(list, landmarks)), named, shapes):
        assert str(symsurf.cohort(given, PAIRS.tolist()).table) == expected
        assert str(symsurf.cohort(given, paired).table) == expected
    found = symsurf.cohort(landmarks, PAIRS)
    assert repr(found) == "Cohort(8 individuals, 15 landmarks)"
    assert "individual x side" in str(found)


FACES = [np.array([[0, 1, 2]]), np.array([[0, 2, 1]])]
GOOD = np.random.default_rng(0).normal(size=(3, 2, COUNT, 3))
MISSING = np.where(np.arange(3)[:, None, None, None] == 1, np.nan, GOOD)
WRONG = [
    (GOOD[:1], PAIRS, None, "of 1 individuals"),
    (GOOD[:, :, :2], [[0, 1]], None, "2 landmarks; allowed are at least"),
    (GOOD[0, 0], PAIRS, None, r"shape \(15, 3\)"),
    (GOOD[..., :1], PAIRS, None, r"shape \(3, 2, 15, 1\)"),
    (MISSING, PAIRS, None, "landmark 0 of individual 1, replicate 0, is missing"),
    (np.zeros_like(GOOD), PAIRS, None, "individual 0 all coincide"),
    ([GOOD[0], GOOD[1, :1]], PAIRS, None, "of individual 1 and"),
    ([[GOOD[0, 0], GOOD[0, 1, 1:]], GOOD[1]], PAIRS, None, "individual 0 have shape"),
    ([GOOD[0, 0], GOOD[1, 0, 1:]], PAIRS, None, r"shape \(14, 3\) of individual 1"),
    ([symsurf.Shape(GOOD[i, 0], FACES[i]) for i in (0, 1)], PAIRS, None, "other faces"),
    ([symsurf.Landmarks(GOOD[i, 0], (f"{i}",) * COUNT) for i in (0, 1)], PAIRS, None, "other names"),
    ("many", PAIRS, None, "cannot be read"),
    (GOOD, [[0, 1], [1, 2]], None, "landmark 1 twice"),
    (GOOD, [[0, 0]], None, "landmark 0 twice"),
    (GOOD, [[0, 15]], None, "landmark 15; allowed are 0 to 14"),
    (GOOD, [[0.0, 1.0]], None, "whole numbers"),
    (GOOD, [0, 1], None, r"shape \(2,\)"),
    (GOOD, [], None, "no pairs"),
    (GOOD, PAIRS, [12, 13], "landmark 14 is in no pair and not on the midline"),
    (GOOD, PAIRS, [11, 12, 13, 14], "landmark 11 twice"),
    (GOOD, symsurf.LandmarkPairs(PAIRS, MIDLINE[:2], np.array([14])), None, "counterpart: 14"),
]  # fmt: skip


@pytest.mark.parametrize("landmarks, pairs, midline, reason", WRONG)
def test_wrong_input_is_named(landmarks, pairs, midline, reason):
    with pytest.raises(symsurf.InvalidInput, match=reason):
        symsurf.cohort(landmarks, pairs, midline)


def test_wrong_parameters_are_named():
    for name in ("permutations", "seed"):
        for value in (-1, 0.5, "3", True):
            with pytest.raises(symsurf.InvalidParameter, match=f"{name} is {value!r}"):
                symsurf.cohort(GOOD, PAIRS, **{name: value})
    with pytest.raises(symsurf.InvalidParameter, match="both given, or neither"):
        symsurf.cohort(GOOD)
    with pytest.raises(symsurf.InvalidParameter, match="both given, or neither"):
        symsurf.cohort(GOOD, PAIRS, other_side=GOOD)


def test_many_vertices_take_little_memory(rng):
    """Of 3000 vertices a table of all distances, or covariances, would be larger than all the rest."""
    import tracemalloc

    half = rng.normal(size=(10, 1500, 3))
    vertices = np.concatenate([half, half * (-1, 1, 1)], axis=1)
    vertices += 0.01 * rng.normal(size=vertices.shape)
    pairs = np.arange(3000).reshape(2, -1).T
    tracemalloc.start()
    symsurf.cohort(vertices, pairs, permutations=9)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 3000**2 * 8 / 2


# The command line


def write_landmarks(folder, landmarks, names):
    files = []
    for i, each in enumerate(landmarks.reshape(-1, COUNT, 3)):
        order = np.random.default_rng(i).permutation(COUNT)  # names tell which is which
        lines = [f"{names[k]},{','.join(map(repr, each[k].tolist()))}" for k in order]
        files.append(f"skull_{i}.csv")
        (folder / files[-1]).write_text("name,x,y,z\n" + "\n".join(lines) + "\n")
    return " ".join(files)


NAMES = [f"{side}_{stem}" for side in "lr" for stem in "abcdef"] + ["n1", "n2", "n3"]
PLAIN = [f"point{i}" for i in range(COUNT)]


def rows_of(path):
    with path.open() as file:
        return list(csv.DictReader(file))


def check_table(path, table):
    for row, name in zip(rows_of(path), ROWS, strict=True):
        assert row["source"] == name
        for key, value in table[name].items():
            assert (row[key] == "") if np.isnan(value) else float(row[key]) == pytest.approx(value)


def test_command_line(rng, tmp_path):
    landmarks = sample(rng, da=0.05, fa=0.05, me=0.02)
    files = write_landmarks(tmp_path, landmarks, NAMES)
    options = (
        "--replicates 2 --permutations 99 --seed 3 --table out/anova.csv --individuals out/i.csv"
    )
    done = run_here(f"cohort {files} {options}", tmp_path)
    assert done.returncode == 0, done.stderr
    expected = symsurf.cohort(landmarks, PAIRS, permutations=99, seed=3)
    check_table(tmp_path / "out/anova.csv", expected.table)
    assert "individual x side" in done.stdout and "6, 3 on the midline, by names" in done.stdout
    rows = rows_of(tmp_path / "out/i.csv")
    assert [row["individual"] for row in rows] == [f"skull_{2 * i}" for i in range(8)]
    lengths = np.linalg.norm(expected.asymmetric, axis=(1, 2))
    np.testing.assert_allclose([float(row["asymmetry"]) for row in rows], lengths)


@pytest.mark.parametrize("names", [NAMES, PLAIN])
def test_command_line_with_pairs(names, rng, tmp_path):
    landmarks = sample(rng, fa=0.05, me=0.02)
    files = write_landmarks(tmp_path, landmarks, names)
    by_name = "".join(f"{names[a]}, {names[b]}\n" for a, b in PAIRS)
    (tmp_path / "pairs.csv").write_text("# left, right\n" + by_name)
    line = f"cohort {files} --pairs pairs.csv --permutations 9 --replicates 2 --table a.csv --json"
    done = run_here(line, tmp_path)
    assert done.returncode == 0, done.stderr
    expected = symsurf.cohort(landmarks, PAIRS, permutations=9).table
    check_table(tmp_path / "a.csv", expected)
    record = json.loads(done.stdout)
    assert record["table"]["side"]["ss"] == pytest.approx(expected["side"]["ss"])
    assert record["table"]["error"]["F"] is None and record["pairs_from"] == "pairs.csv"


def test_command_line_of_one_tps(rng, tmp_path):
    landmarks = sample(rng, fa=0.05, me=0.02, d=2)
    texts = [
        "LM=15\n" + "\n".join(f"{x!r} {y!r}" for x, y in each.tolist()) + f"\nID={i}\nSCALE=0.5\n"
        for i, each in enumerate(landmarks.reshape(-1, COUNT, 2))
    ]
    (tmp_path / "all.tps").write_text("\n".join(texts))
    (tmp_path / "pairs.csv").write_text("\n".join(f"{a},{b}" for a, b in PAIRS))
    line = "cohort all.tps --pairs pairs.csv --replicates 2 --table a.csv --permutations 9"
    done = run_here(line, tmp_path)
    assert done.returncode == 0, done.stderr
    check_table(tmp_path / "a.csv", symsurf.cohort(landmarks, PAIRS, permutations=9).table)


def test_no_specimen_becomes_a_formula(rng, tmp_path):
    """The name of a specimen is what its file says, and a spreadsheet may open the table."""
    texts = [
        "LM=15\n" + "\n".join(f"{x!r} {y!r}" for x, y in each.tolist()) + f"\nID={name}\n"
        for each, name in zip(sample(rng, fa=0.05, d=2)[:, 0], ["=1+1", "@a", "-b", "c"])
    ]
    (tmp_path / "all.tps").write_text("".join(texts))
    (tmp_path / "pairs.csv").write_text("\n".join(f"{a},{b}" for a, b in PAIRS))
    line = "cohort all.tps --pairs pairs.csv --individuals i.csv --permutations 9"
    assert run_here(line, tmp_path).returncode == 0
    names = [row["individual"] for row in rows_of(tmp_path / "i.csv")]
    assert names == ["'=1+1", "'@a", "'-b", "c"]


def test_command_line_finds_pairs_by_the_mirror(rng, tmp_path):
    """Where no names tell: over the plane of the mean."""
    points, plane = mirrored_surface(30, 3)
    pairs = symsurf.landmark_pairs(points, plane)
    assert len(pairs.pairs) == 15
    made = points + 0.01 * rng.normal(size=(6, 1, *points.shape))
    texts = [
        f"LM3={len(points)}\n" + "\n".join(" ".join(map(repr, row)) for row in each.tolist()) + "\n"
        for each in moved(made, rng)[:, 0]
    ]
    (tmp_path / "all.tps").write_text("\n".join(texts))
    done = run_here("cohort all.tps --table a.csv --permutations 9", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "15, 0 on the midline, by the mirror found" in done.stdout
    check_table(tmp_path / "a.csv", symsurf.cohort(made, pairs, permutations=9).table)


def bodies(count=5):
    """Meshes of one topology, of which one side is bent more and more."""
    pyvista = pytest.importorskip("pyvista")
    ball = pyvista.Icosphere(radius=1, nsub=3)
    x = np.asarray(ball.points, dtype=float)
    x = x * (1 + 0.2 * np.sin(2 * x[:, [1]] + 1) + 0.1 * x[:, [2]] ** 3) * (1, 1.3, 0.8)
    right = np.maximum(x[:, :1], 0)
    shapes = [
        x * (1 + 0.02 * i * np.array([0, 1, 0.5])) + 0.01 * i * right * (0, 1, 0)
        for i in range(count)
    ]
    return np.array(shapes), ball.regular_faces, x


def write_mesh(path, points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(map(repr, row)) for row in points.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces.tolist()]
    path.write_text("\n".join(lines) + "\n")


def test_command_line_of_meshes(tmp_path):
    shapes, faces, x = bodies()
    for i, shape in enumerate(shapes):
        write_mesh(tmp_path / f"m{i}.off", shape, faces)
    partner = [np.linalg.norm(x - row * (-1, 1, 1), axis=1).argmin() for row in x]
    pairs = [(a, b) for a, b in enumerate(partner) if a < b]
    (tmp_path / "pairs.csv").write_text("\n".join(f"{a},{b}" for a, b in pairs))
    files = " ".join(f"m{i}.off" for i in range(5))
    expected = symsurf.cohort(shapes, pairs, permutations=9).table
    for options in ("--pairs pairs.csv", ""):
        done = run_here(f"cohort {files} {options} --table a.csv --permutations 9", tmp_path)
        assert done.returncode == 0, done.stderr
        assert f"{len(pairs)}, {len(x) - 2 * len(pairs)} on the midline" in done.stdout
        check_table(tmp_path / "a.csv", expected)


def test_report_of_a_cohort(rng, tmp_path):
    pytest.importorskip("trame_vtk")
    shapes, faces, _ = bodies()
    for i, shape in enumerate(shapes):
        write_mesh(tmp_path / f"m{i}.off", shape, faces)
    meshes = " ".join(f"m{i}.off" for i in range(5))
    files = write_landmarks(tmp_path, sample(rng, fa=0.05, me=0.02), NAMES)
    for given, has_scene in ((meshes, True), (f"{files} --replicates 2", False)):
        done = run_here(f"cohort {given} --permutations 9 --report page.html", tmp_path)
        assert done.returncode == 0, done.stderr
        page = (tmp_path / "page.html").read_text()
        assert "Procrustes ANOVA" in page and "fluctuating asymmetry" in page
        assert ("<iframe" in page) == has_scene


REFUSED = [
    ("skull_0.csv", "of 1 individuals"),
    ("skull_0.csv skull_1.csv skull_2.csv --replicates 2", "3 specimens; allowed is a multiple"),
    ("skull_0.csv skull_1.csv --replicates 0", "replicates is 0"),
    ("skull_0.csv skull_1.csv --replicates two", "replicates is 'two'"),
    ("skull_0.csv skull_1.csv --permutations many", "permutations is 'many'"),
    ("skull_0.csv none.csv", "none.csv: there is no such file"),
    (
        "skull_0.csv lacks.csv",
        "lacks.csv: its landmarks are not those of skull_0.csv: it lacks l_a",
    ),
    ("skull_0.csv missing.csv", "missing.csv: landmark l_a is missing"),
    ("skull_0.csv alike.csv", "alike.csv: two landmarks are called 'l_a'"),
    ("skull_0.csv m0.off", "m0.off: of this and skull_0.csv one has landmarks"),
    ("m0.off m1.off", "m1.off: its faces are not those of m0.off"),
    ("skull_0.csv skull_1.csv --pairs none.csv", "none.csv"),
    ("skull_0.csv skull_1.csv --pairs wrong.csv", "wrong.csv: line 1: 'l_z' is no landmark"),
    ("skull_0.csv skull_1.csv --pairs wide.csv", "wide.csv: line 2: there are 3 cells"),
    ("skull_0.csv skull_1.csv --pairs twice.csv", "twice.csv: line 2: one of the two stands twice"),
    ("skull_0.csv skull_1.csv --table anova.txt", "allowed is the suffix .csv"),
    ("skull_0.csv skull_1.csv --table skull_0.csv", "is an input or another output"),
    ("skull_0.csv skull_1.csv --individuals a.csv --table a.csv", "is an input or another output"),
]


@pytest.mark.parametrize("line, reason", REFUSED)
def test_command_line_refuses(line, reason, rng, tmp_path):
    """With the reason in one line, and nothing written."""
    write_landmarks(tmp_path, sample(rng, n=3, r=1), NAMES)
    text = (tmp_path / "skull_0.csv").read_text()
    row = next(each for each in text.splitlines() if each.startswith("l_a"))
    (tmp_path / "lacks.csv").write_text(text.replace(f"{row}\n", ""))
    (tmp_path / "alike.csv").write_text(text.replace("l_b", "l_a"))
    (tmp_path / "missing.csv").write_text(text.replace(row, "l_a,,,"))
    (tmp_path / "wrong.csv").write_text("l_z,r_z\n")
    (tmp_path / "wide.csv").write_text("l_a,r_a\nl_a,r_a,n1\n")
    (tmp_path / "twice.csv").write_text("l_a,r_a\nl_a,r_b\n")
    for i, faces in enumerate(FACES):
        write_mesh(tmp_path / f"m{i}.off", GOOD[i, 0], faces)
    before = sorted(tmp_path.iterdir())
    options = "" if "--table" in line else " --table table.csv"
    done = run_here(f"cohort {line}{options}", tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("symsurf: ") and reason in done.stderr
    assert done.stderr.count("\n") == 1 and sorted(tmp_path.iterdir()) == before
