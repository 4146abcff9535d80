"""Cohorts: their ANOVA against one by dummy variables, and known asymmetry."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from cohort_samples import COUNT, MIDLINE, PAIRS, ROWS, mirrored, moved, relabelled, sample

import symsurf

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


# SS and F of R's geomorph 4.0.8 and RRPP 2.1.2: ``bilat.symmetry(A, ind, replicate, object.sym = TRUE,
# land.pairs)`` of the landmarks below, and ``object.sym = FALSE`` with ``side``, of them and the other side.
GEOMORPH = {
    "object": [
        (0.07527185643143261, 1.7025989943432223),
        (0.024794480468388585, 1.6825036412857395),
        (0.04420997350610367, 48.127418792856304),
        (0.0024496070148778137, np.nan),
    ],
    "matching": [
        (0.12741634399048293, 303.0875017103518),
        (0.00020154913077066738, 1.4382854021083198),
        (0.00042039458331821766, 0.31894629049661816),
        (0.0035148620804975328, np.nan),
    ],
}


@pytest.mark.parametrize("kind", GEOMORPH)
def test_anova_is_that_of_geomorph(kind):
    def drawn(r: int, start: int) -> np.ndarray:
        shape = (4, r, 7, 3)
        return np.sin((start + np.arange(np.prod(shape))) ** 2.0).reshape(shape)

    body = np.array(
        [(3, 1, 0), (-3, 1, 0), (2, -2, 1), (-2, -2, 1), (0, 3, 1), (0, -1, 2), (0, 0, -2)]
    )
    landmarks = body + 0.3 * drawn(1, 0) + 0.05 * drawn(2, 1000)
    other = {"other_side": landmarks + 0.05 * drawn(2, 2000)}
    given = {"pairs": [[0, 1], [2, 3]]} if kind == "object" else other
    table = symsurf.cohort(landmarks, **given, permutations=0).table
    found = [(row["ss"], row["F"]) for row in table.values()]
    np.testing.assert_allclose(found, GEOMORPH[kind], rtol=4e-12)


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
    assert found.table["individual"]["ss"] > 0.01
    for name in ROWS[1:]:  # rounding is nothing, and has no F
        row = found.table[name]
        assert row["ss"] == 0 and np.isnan(row["F"]) and np.isnan(row["p"])


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
