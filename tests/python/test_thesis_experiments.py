"""The thesis's experiments in lines of shell, against what its text says."""

from __future__ import annotations

import json

import numpy as np
import pytest
import thesis_transcription as thesis
from command_line import run_here
from seeds import FULL, SEEDS, full_run

import symsurf
from symsurf import metrics, synthetic
from symsurf.reading.saved_text import read_text
from symsurf.saving.truth import read_truth, truth_path
from symsurf.thesis import tables

SAMPLES = {
    "constant distance": "perpendicular --surface f1 --resolution 10",
    "waves": "perpendicular --surface f5 --resolution 10 --waves 2 --max-distance 0.9",
    "fixed direction": "fixed --surface f2 --cloud f1 --shift 4 --resolution 10",
    "hemisphere": "perpendicular --surface f6 --extent 1 --resolution 14 --min-distance 0.2",
}
DAMAGES = {
    "whole": None,
    "noise": "noise --high 0.2 --seed 3",
    "hole": "removal --box-low 0,0,0 --box-high 2,2,4",
    "uneven": "thinning --ratio 4 --direction 0,0,1 --seed 2",
    "turned": "rotation --roll 10 --pitch 15 --yaw 20",
}


def shell(line: str, folder) -> str:
    done = run_here(line, folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


EVERY = [(sample, damage) for sample in SAMPLES for damage in DAMAGES]
# By default each damage, done to one of the samples.
FEW = [(list(SAMPLES)[i % len(SAMPLES)], damage) for i, damage in enumerate(DAMAGES)]


@pytest.fixture(params=FEW if SEEDS < FULL else EVERY, ids=" ".join)
def cloud(request, tmp_path):
    """A folder with the damaged sample in points.xyz, its truth beside it."""
    sample, damage = request.param
    if DAMAGES[damage] is None:
        shell(f"generate {SAMPLES[sample]} --output points.xyz", tmp_path)
    else:
        shell(f"generate {SAMPLES[sample]} --output whole.xyz", tmp_path)
        shell(f"damage {DAMAGES[damage]} whole.xyz --output points.xyz", tmp_path)
    return tmp_path


def detected(folder, method: str, *options: str) -> dict:
    line = " ".join(["detect points.xyz --output . --formats json,txt --method", method, *options])
    shell(line, folder)
    return json.loads((folder / "points.json").read_text())


def ascending(points) -> np.ndarray:
    """Rows by x, then y, then z: in this order the methods take the first of equals."""
    return np.lexsort(points.T[::-1])


def expect_separation(found: dict, expected: thesis.Separated) -> None:
    statistics = found["statistics"]
    assert statistics["thesis_score"] == pytest.approx(expected.score, abs=1e-12)
    rows = np.array(statistics["directions"], dtype=float)
    assert rows.shape == (91, 8)
    # Directions whose scores are equal but for rounding may each win.
    if np.allclose(statistics["direction"], expected.direction, atol=1e-12):
        assert statistics["projection_error"] == pytest.approx(expected.error, abs=1e-12)
        assert statistics["clearance"] == pytest.approx(expected.clearance, abs=1e-12)


def expect_pairs(found: dict, expected, points) -> None:
    """The same partners, or others as near to the line."""
    pairs = np.array(found["pairs"])
    assert pairs.shape == expected.shape and (pairs[:, 0] == expected[:, 0]).all()
    assert (pairs[:, 1] == expected[:, 1]).mean() > 0.6
    midpoints = points[pairs].mean(axis=1)
    assert np.allclose(found["surface_points"], midpoints, rtol=0, atol=1e-12)


def test_algorithm_1(cloud):
    points = symsurf.read(cloud / "points.xyz").points
    expected = thesis.separation(points[ascending(points)])
    expect_separation(detected(cloud, "separation"), expected)


@pytest.mark.parametrize("estimation", ["pca", "regression"])
def test_algorithm_2(cloud, estimation):
    points = symsurf.read(cloud / "points.xyz").points
    points = points[ascending(points)]
    found = detected(cloud, "separation_normals", "--normal-estimation", estimation)
    normals = symsurf.estimate_normals(points, method=estimation)
    expect_separation(found, thesis.separation_normals(points, normals, estimation == "pca"))


@pytest.mark.parametrize("estimation", ["pca", "regression"])
def test_algorithm_3(cloud, estimation):
    points = symsurf.read(cloud / "points.xyz").points
    found = detected(cloud, "normals_only", "--normal-estimation", estimation)
    order = ascending(points)
    normals = np.empty_like(points)
    normals[order] = symsurf.estimate_normals(points[order], method=estimation)
    expected = order[thesis.normals_only(points[order], normals[order])]
    expected = expected[expected[:, 0].argsort()]
    expect_pairs(found, expected, points)
    squared = [
        thesis.squared_from_line(points[partner][None], points[i], normals[i])[0]
        for i, partner in expected
    ]
    assert np.allclose(found["residuals"], np.sqrt(squared), rtol=0, atol=1e-12)


def test_normals_are_those_of_the_text(rng):
    """Where the ten nearest are the same whoever sorts them."""
    points = rng.normal(size=(150, 3)) * (3, 2, 0.3)
    pca = symsurf.estimate_normals(points, method="pca")
    cosine = np.abs((pca * thesis.pca_normals(points)).sum(axis=1))
    assert np.allclose(cosine, 1, atol=1e-12)
    regression = symsurf.estimate_normals(points, method="regression")
    assert np.allclose(regression, thesis.regression_normals(points), atol=1e-9)


def test_algorithm_4(tmp_path):
    shell(
        "generate spherical --cloud f1 --resolution 12 --first-vertex 0 --second-vertex 143"
        " --radius-divisor 2.5 --output points.xyz",
        tmp_path,
    )
    options = "--sample-size 12", "--radii 3"
    found = detected(tmp_path, "sphere_thesis", *options)["statistics"]
    points = symsurf.read(tmp_path / "points.xyz").points
    few = thesis.simplified(points, 12)
    assert np.allclose(np.sort(few, axis=0), np.sort(symsurf.downsample(points, 12), axis=0))
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    best = thesis.best_candidate(few, np.linspace(diagonal / 5, diagonal / 3, 3))
    assert found["start_measure"] == pytest.approx(best.measure, abs=1e-12)
    assert np.allclose(found["start_centre"], best.centre, atol=1e-9)
    assert found["start_radius"] == pytest.approx(best.radius)
    sphere = read_text(tmp_path / "points.txt").sphere
    assert found["measure"] == pytest.approx(
        thesis.sphere_measure(points, sphere.centre, sphere.radius), abs=1e-9
    )
    assert found["measure"] >= thesis.sphere_measure(points, best.centre, best.radius) - 1e-9


def test_evaluate_reads_the_thesis_s_file_back(cloud):
    detected(cloud, "separation")
    printed = json.loads(shell("evaluate points.txt --sample points.xyz --json", cloud))
    text = (cloud / "points.txt").read_text().splitlines()
    figures = [line for line in text if line.startswith("#")]
    assert text[: len(figures)] == figures
    found = np.array([[float(x) for x in line.split(",")] for line in text[len(figures) :]])
    truth = read_truth(truth_path(cloud / "points.xyz")).mirror
    errors = metrics.surface_errors(found, truth)
    assert printed["rmse"] == errors.rmse and printed["e_max"] == errors.e_max
    assert printed["e_avg"] == errors.e_avg and printed["bias"] == errors.bias
    assert printed["skipped"] + errors.counted == len(found)
    points = symsurf.read(cloud / "points.xyz").points
    assert printed["coverage"] == metrics.coverage(found, truth, points)
    assert printed["distance"] == metrics.surface_distance(found, truth, points)


def test_files_that_differ_in_their_suffix_have_truths_of_their_own(tmp_path):
    shell("generate fixed --resolution 6 --output points.xyz", tmp_path)
    shell("damage removal points.xyz --probability 0.5 --output points.csv", tmp_path)
    for suffix in ".xyz", ".csv":
        path = tmp_path / f"points{suffix}"
        points, truth = symsurf.read(path).points, read_truth(truth_path(path))
        images = truth.mirror.reflect(points[truth.pairs[:, 0]])
        np.testing.assert_allclose(points[truth.pairs[:, 1]], images, atol=1e-12)
    assert len(truth.pairs) < 36


def test_damaged_points_without_truth_take_over_none(tmp_path):
    shell("generate fixed --resolution 6 --output damaged.xyz", tmp_path)
    (tmp_path / "bare.xyz").write_bytes((tmp_path / "damaged.xyz").read_bytes())
    shell("damage thinning bare.xyz --ratio 2 --output damaged.xyz", tmp_path)
    assert not truth_path(tmp_path / "damaged.xyz").exists()


def test_a_truth_of_other_points_is_refused(tmp_path):
    shell("generate fixed --resolution 6 --output points.xyz", tmp_path)
    lines = (tmp_path / "points.xyz").read_text().splitlines()
    (tmp_path / "points.xyz").write_text("\n".join(lines[:10]) + "\n")
    done = run_here("damage noise points.xyz --output damaged.xyz", tmp_path)
    assert done.returncode != 0
    assert "the truth pairs point" in done.stderr and "0 to 9" in done.stderr
    assert not (tmp_path / "damaged.xyz").exists()


def test_points_that_cannot_be_written_leave_the_truth(tmp_path):
    shell("generate fixed --resolution 6 --output points.xyz", tmp_path)
    (tmp_path / "taken.xyz").mkdir()
    done = run_here("damage noise points.xyz --output taken.xyz", tmp_path)
    assert done.returncode != 0
    assert not truth_path(tmp_path / "taken.xyz").exists()


def test_evaluate_goes_on_after_a_file_that_is_not_there(tmp_path):
    shell("generate perpendicular --output points.xyz", tmp_path)
    shell("detect points.xyz --method perpendicular --output . --formats txt", tmp_path)
    done = run_here("evaluate none.txt points.txt --sample points.xyz --json", tmp_path)
    assert done.returncode == 1
    assert done.stderr.splitlines() == ["symsurf: none.txt: No such file or directory"]
    assert json.loads(done.stdout)["file"] == "points.txt"


def test_evaluate_a_sphere(tmp_path):
    shell("generate spherical --cloud f1 --centre 1,1,2 --output points.xyz", tmp_path)
    detected(tmp_path, "sphere_thesis", "--sample-size 40", "--radii 3")
    lines = (tmp_path / "points.txt").read_text().splitlines()
    centre, radius = [line for line in lines if not line.startswith("#")]
    assert len(centre.split(",")) == 3 and float(radius) > 0
    printed = json.loads(shell("evaluate points.txt --sample points.xyz --json", tmp_path))
    truth = read_truth(truth_path(tmp_path / "points.xyz")).mirror
    points = symsurf.read(tmp_path / "points.xyz").points
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    gap = np.linalg.norm(np.array([float(x) for x in centre.split(",")]) - truth.centre)
    assert printed["e_c"] == pytest.approx(gap / diagonal)
    assert printed["e_r"] == pytest.approx(abs(float(radius) - truth.radius) / diagonal)


@full_run
def test_four_lines_with_the_grid(tmp_path):
    """Table 5.5, uneven density: Experiment 2 works on a quarter of Experiment 1's points."""
    shell("generate fixed --surface f1 --cloud f5 --shift 4 --output whole.xyz", tmp_path)
    shell(f"damage {DAMAGES['uneven']} whole.xyz --output points.xyz", tmp_path)
    found = detected(tmp_path, "separation", "--downsample 4")
    points = symsurf.read(tmp_path / "points.xyz").points
    expected = symsurf.detect(symsurf.downsample(points, -(-len(points) // 4)), "separation")
    assert found["pairs"] == expected.pairs.tolist()
    assert "coverage" in shell("evaluate points.txt --sample points.xyz", tmp_path)


@full_run
def test_clean_fixed_data_is_exact(tmp_path):
    """Table 5.1, experiments that a plane separates."""
    for cloud, surface in ("f5", "f1"), ("f1", "f2"), ("f5", "f3"), ("f1", "f4"):
        shell(
            f"generate fixed --cloud {cloud} --surface {surface} --shift 6 --output points.xyz",
            tmp_path,
        )
        detected(tmp_path, "separation")
        printed = json.loads(shell("evaluate points.txt --sample points.xyz --json", tmp_path))
        points = symsurf.read(tmp_path / "points.xyz").points
        assert printed["rmse"] <= 1e-12 * np.linalg.norm(np.ptp(points, axis=0))
        assert printed["coverage"] == 1


def refused(line: str, says: str, folder) -> int:
    """Its exit code, once it has said one clear line."""
    shell("generate fixed --resolution 6 --output points.xyz", folder)
    done = run_here(line, folder)
    assert done.stdout == ""
    assert says in done.stderr and len(done.stderr.splitlines()) == 1
    return done.returncode


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("generate perpendicular --surface f6 --extent 9 --resolution 2", "f6"),
        ("generate fixed --surface f6 --cloud f4 --extent 0", "extent is 0"),
        ("generate perpendicular --waves 1 --min-distance 2 --max-distance 1", "max_distance is 1"),
        ("generate perpendicular --min-distance -1", "min_distance is -1"),
        ("generate perpendicular --surface f7", "surface is f7"),
        ("generate spherical --centre 50,0,0", "inside the sphere"),
        ("generate spherical --first-vertex 3 --second-vertex 3", "differ"),
        ("generate spherical --first-vertex 3 --second-vertex 99999", "99999"),
        ("damage noise points.xyz --box-low 1,0,0 --box-high 0,1,1", "minimum"),
        ("damage noise points.xyz --low 2 --high 1", "low"),
        ("damage removal points.xyz --probability 2", "probability is 2"),
        ("damage removal points.xyz --box-low 1,0 --box-high 2,1,1", "box_low"),
        ("damage thinning points.xyz --ratio 0.5", "ratio is 0.5"),
        ("damage thinning points.xyz --direction 0,0,0", "direction is"),
        ("damage rotation points.xyz --roll nan", "roll is nan"),
        ("damage noise points.xyz --seed -1", "seed is -1"),
        ("damage noise points.xyz --seed 1.5", "seed is '1.5'"),
        ("damage noise points.xyz --seed 18446744073709551616", "seed is 18446744073709551616"),
    ],
)
def test_bad_input_is_one_clear_line_and_no_file(tmp_path, line, says):
    assert refused(f"{line} --output made.xyz", says, tmp_path) == 2
    assert not (tmp_path / "made.xyz").exists()
    assert not (tmp_path / "made.xyz.truth.json").exists()


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("generate fixed --output nowhere/made.xyz", "'nowhere/made.xyz'"),
        ("generate fixed --output points.xyz/made.xyz", "'points.xyz/made.xyz'"),
        ("damage noise points.xyz --output nowhere/made.xyz", "'nowhere/made."),
        ("detect points.xyz --output points.xyz", "'points.xyz'"),
        ("demo --output points.xyz", "'points.xyz'"),
    ],
)
def test_what_cannot_be_written_is_one_clear_line(tmp_path, line, says):
    assert refused(line, says, tmp_path) == 2


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ("--method sphere_thesis --min-radius-divisor 3 --max-radius-divisor 5", "radius_divisor"),
        ("--method normals_only --neighbours 80", "72 points"),
        ("--method separation_normals --neighbours 2", "neighbours is 2"),
        ("--method separation --steps 0", "steps is 0"),
        ("--method separation --downsample 0.5", "downsample is 0.5"),
        ("--method separation --downsample many", "downsample is many"),
    ],
)
def test_bad_detections_are_one_clear_line(tmp_path, options, says):
    assert refused(f"detect points.xyz {options}", says, tmp_path) in (1, 2)


def test_undefined_places_are_skipped_and_counted(tmp_path):
    said = shell(
        "generate fixed --surface f6 --cloud f1 --extent 1 --resolution 20 --output points.xyz",
        tmp_path,
    )
    sample = synthetic.mirror_fixed(synthetic.surface("f1").sample(1, 20), "f6", 3)
    assert sample.skipped > 0 and f"{sample.skipped} skipped" in said
    assert np.isfinite(sample.points).all()
    result = symsurf.detect(sample.points, "separation")
    errors = metrics.surface_errors(result.surface_points + (0.5, 0, 0), "f6")
    assert errors.skipped > 0 and errors.counted + errors.skipped == len(result.surface_points)


def test_rows_say_what_the_text_says():
    """Which surfaces are incorrect, and what the uniform grid repairs; Figure 5.8: without normals
    what a plane does not separate is not found."""
    rmse = {
        (row.table, row.method, row.name): tables.measure(row).figures["rmse"]
        for row in tables.rows()
        if (row.table, row.name)
        in {("5.8", "experiment 3"), ("5.5", "uneven 1"), ("5.5", "uneven 2")}
        or (row.table in ("5.2", "5.3") and row.name in ("experiment 3", "experiment 5"))
        if not row.method.startswith("sphere")
    }
    assert rmse["5.2", "separation_normals", "experiment 5"] > 0.3
    assert rmse["5.3", "normals_only", "experiment 5"] > 0.1
    for method, share in ("separation", 0.05), ("separation_normals", 0.5):
        assert rmse["5.5", method, "uneven 2"] < share * rmse["5.5", method, "uneven 1"]
    with_normals = rmse["5.2", "separation_normals", "experiment 3"]
    assert rmse["5.8", "separation", "experiment 3"] > 3 * with_normals


@full_run
def test_the_demonstration_prints_every_row_of_the_tables_asked_for(tmp_path):
    shown = 1 + 4 * (4 + 2)  # in figures
    assert len(list(tables.rows())) == (7 + 6 + 6 + 5 + 23) + (5 + 6) + shown
    printed = shell("demo thesis --tables 5.3 5.1 --no-pictures --output pictures", tmp_path)
    lines = [line for line in printed.splitlines() if line and not line.startswith("table")]
    assert len(lines) == 7 + 6


def test_tables_that_the_thesis_lacks_are_refused(tmp_path):
    done = run_here("demo thesis --tables 6.1 --no-pictures", tmp_path)
    assert done.returncode == 2 and "tables is 6.1; allowed are 5.1, 5.2" in done.stderr
    done = run_here("demo --tables 5.1 --no-pictures", tmp_path)
    assert done.returncode == 2 and "tables is given for shapes" in done.stderr
