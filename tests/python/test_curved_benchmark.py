"""The benchmark of curved mirrors: its truth, its files and its measures."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_line import run_here

import symsurf
from symsurf.benchmark import case_names
from symsurf.benchmark.answers import Answer
from symsurf.benchmark.files import read_benchmark
from symsurf.benchmark.scores import figures_of
from symsurf.synthetic import benchmark


def samples(*patterns, size="small", seed=0):
    return list(benchmark(size, seed, patterns))


def nearest(points, others):
    """Distances (n,) to the nearest of the others."""
    return np.array([np.linalg.norm(others - x, axis=1).min() for x in points])


def true_mirror(sample):
    return symsurf.make_mirror(sample.kind, sample.mirror)


def test_images_are_points_where_sides_are_exact():
    for sample in samples("*-exact"):
        assert (sample.partners[sample.partners] == np.arange(len(sample.points))).all()
        assert (sample.images == sample.points[sample.partners]).all(), sample.name
        assert sample.partners.min() >= 0 and len(sample.points) == 2000


def test_images_lie_on_the_other_side_where_sides_have_points_of_their_own():
    for sample in samples("head-*-clean", "part-*-clean"):
        if sample.bend == "none":
            continue
        assert (sample.partners == -1).all()
        spacing = np.median(np.sort(nearest(sample.points[:100], sample.points[100:])))
        gaps = nearest(sample.images[:100], sample.points)
        assert np.median(gaps) < 1.5 * spacing, sample.name


@pytest.mark.parametrize("damage", ["clean", "noise-2", "hole", "half", "asymmetry-3"])
def test_images_are_those_of_the_mirror(damage):
    for bend in ("straight", "bent", "domed"):
        (sample,) = samples(f"creature-{bend}-{damage}")
        images = true_mirror(sample).reflect(sample.points)
        assert np.abs(images - sample.images).max() < 1e-11 * sample.diagonal


@pytest.mark.parametrize("bend", ["waved", "twisted"])
@pytest.mark.parametrize("damage", ["exact", "noise-2"])
def test_graphs_are_halfway_and_across(bend, damage):
    (sample,) = samples(f"head-{bend}-{damage}")
    m, to_frame = sample.mirror, lambda x: x @ sample.mirror["rotation"] / sample.mirror["scale"]
    foot = to_frame((sample.points + sample.images) / 2 - m["translation"])
    x, y = foot[:, 0], foot[:, 1]
    if bend == "waved":
        turns = 2 * np.pi * (m["frequency"] * x + m["phase"])
        height = m["amplitude"] * np.sin(turns)
        slopes = 2 * np.pi * m["frequency"] * m["amplitude"] * np.cos(turns), 0 * y
    else:
        height, slopes = m["slope"] * x * y, (m["slope"] * y, m["slope"] * x)
    assert np.abs(height - foot[:, 2]).max() < 1e-12
    chords = to_frame(sample.images - sample.points)
    across = np.abs(chords - chords[:, 2:] * np.column_stack([-slopes[0], -slopes[1], 0 * x + 1]))
    assert across.max() < 1e-9


def test_noise_is_as_large_as_it_says():
    for share, damage in ((0.005, "noise-0.5"), (0.01, "noise-1"), (0.02, "noise-2")):
        (noisy,), (clean,) = samples(f"head-bent-{damage}"), samples("head-bent-clean")
        # The cylinder's distances: noise across a smooth body's sides is uncorrelated with them.
        assert clean.diagonal == pytest.approx(noisy.diagonal, rel=0.02)
        moved = nearest(noisy.points[:200], samples("head-bent-clean", size="medium")[0].points)
        # Across the surface, half of the squares' thirds; the nearest point is some spacing off.
        across = np.sqrt((moved**2).mean()) / noisy.diagonal
        assert 0.4 * share / np.sqrt(3) < across < 2 * share / np.sqrt(3) + 0.004


def test_the_plane_is_that_of_least_squares_where_sides_differ():
    """No tilt or shift of it takes the points of a straight body nearer to their counterparts: the
    images of a nearly symmetric body are not its counterparts, so that these are made here."""
    (near,), (far,) = samples("head-straight-asymmetry-1"), samples("head-straight-asymmetry-3")
    for sample, least, most in ((near, 0.001, 0.02), (far, 0.003, 0.06)):
        gaps = nearest(sample.images[::10], sample.points) / sample.diagonal
        spacing = np.median(nearest(sample.points[:100], sample.points[100:])) / sample.diagonal
        assert least < np.median(gaps) < most + spacing


def test_controls_have_no_plane():
    """Over the planes through the middle across 200 directions, images miss the cloud by more than
    the points' spacing, which those of a symmetric body do not."""
    rng = np.random.default_rng(0)

    def best(points):
        points = points[:400] - points[:400].mean(axis=0)
        axes = np.linalg.svd(points, full_matrices=False)[2]
        normals = np.vstack([axes, rng.normal(size=(200, 3))])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        misses = [
            np.median(nearest(x[:100] - 2 * np.outer(x[:100] @ n, n), x))
            for n, x in ((n, points) for n in normals)
        ]
        return min(misses) / np.median(nearest(points[:100], points[100:]))

    for shape in ("creature", "part", "mask", "sheets"):
        (control,) = samples(f"{shape}-none-clean")
        assert control.images is None and control.kind == "none"
        assert best(control.points) > 1.1, shape


def test_the_same_bits_every_time():
    first, again = samples("*-twisted-hole", seed=7), samples("*-twisted-hole", seed=7)
    for one, other in zip(first, again, strict=True):
        assert one.points.tobytes() == other.points.tobytes()
        assert one.images.tobytes() == other.images.tobytes()
    assert not np.array_equal(first[0].points, samples("*-twisted-hole", seed=8)[0].points)


def test_sizes_share_their_bodies():
    (small,), (medium,) = (samples("part-bent-clean", size=s) for s in ("small", "medium"))
    assert len(small.points) == 2000 and len(medium.points) == 10000
    assert small.mirror["radius"] == medium.mirror["radius"]
    assert small.diagonal == pytest.approx(medium.diagonal, rel=0.02)


def test_figures():
    (sample,) = samples("mask-bent-clean")
    right = figures_of(sample, Answer(sample.images, "cylinder", True))
    assert right == (0, 0, 1, 1, 1)
    images = sample.images.copy()
    images[:200] += 0.02 * sample.diagonal / np.sqrt(3)
    images[200:220] = np.nan
    moved = figures_of(sample, Answer(images, "plane", True))
    assert moved.within == pytest.approx(0.89) and moved.kind == 0
    assert moved.median == 0 and moved.ninetieth == pytest.approx(0.02)
    assert figures_of(sample, None) == (np.inf, np.inf, 0, 0, 0)
    (control,) = samples("mask-none-clean")
    assert figures_of(control, Answer(None, "none", False))[3:] == (1, 0)
    assert figures_of(control, Answer(control.points, "plane", True))[3:] == (0, 1)
    assert figures_of(control, None).kind == 0


def test_from_files_to_figures(tmp_path):
    line = "generate benchmark --size small --seed 2 --cases *-domed-clean *-none-clean"
    assert run_here(f"{line} --output made", tmp_path).returncode == 0
    read = read_benchmark(tmp_path / "made")
    for one, other in zip(read, samples("*-domed-clean", "*-none-clean", seed=2), strict=True):
        assert (one.points == other.points).all() and one.diagonal == other.diagonal
        assert one.images is None or (one.images == other.images).all()

    folder = tmp_path / "answers"
    folder.mkdir()
    for sample in read:
        if sample.images is None:
            (folder / f"{sample.name}.json").write_text('{"mirror": null}')
        elif sample.shape == "head":
            np.savetxt(folder / f"{sample.name}.csv", sample.images, delimiter=",", fmt="%.17g")
        else:
            mirror = {"kind": "sphere"} | {
                k: np.asarray(v).tolist() for k, v in sample.mirror.items()
            }
            (folder / f"{sample.name}.json").write_text(json.dumps({"mirror": mirror}))
    done = run_here("evaluate answers --benchmark made --json --table table.csv", tmp_path)
    records = [json.loads(text) for text in done.stdout.splitlines()]
    assert len(records) == 10 and done.stderr == ""
    for record in records:
        if record["case"].endswith("none-clean"):
            assert record["kind"] == 1 and record["found"] == 0 and record["median"] is None
        else:
            assert record["median"] < 1e-12 and record["within"] == 1 and record["found"] == 1
    assert len((tmp_path / "table.csv").read_text().splitlines()) == 11
    assert "without a mirror" in run_here("evaluate answers --benchmark made", tmp_path).stdout


def test_our_results_are_answers(tmp_path):
    cases = "sheets-straight-exact sheets-waved-exact"
    run_here(f"generate benchmark --size small --cases {cases} --output made", tmp_path)
    for method, kind in (("plane", [1, 0]), ("perpendicular", [0, 1])):
        run_here(f"detect made/points --method {method} --output {method}", tmp_path)
        done = run_here(f"evaluate {method} --benchmark made --json", tmp_path)
        records = [json.loads(text) for text in done.stdout.splitlines()]
        assert [record["kind"] for record in records] == kind
        assert records[kind.index(1)]["median"] < 0.001


def test_bad_input_is_named(tmp_path):
    for line, words in {
        "generate benchmark --size huge --output made": ("huge", "small, medium, large"),
        "generate benchmark --cases head-curly --output made": ("head-curly", "260 cases"),
        "generate benchmark --seed -1 --output made": ("seed is -1",),
        "evaluate answers --benchmark nowhere": ("truth.json",),
        "evaluate answers --sample points.xyz --table t.csv": ("--benchmark",),
    }.items():
        done = run_here(line, tmp_path)
        assert done.returncode == 2 and all(word in done.stderr for word in words), line
    with pytest.raises(symsurf.InvalidParameter, match="head-curly"):
        case_names(["head-curly"])
    run_here("generate benchmark --size small --cases head-bent-clean --output made", tmp_path)
    (tmp_path / "head-bent-clean.csv").write_text("1,2,3\n")
    done = run_here("evaluate . --benchmark made", tmp_path)
    assert done.returncode == 2 and "1 images" in done.stderr
    (tmp_path / "head-bent-clean.csv").unlink()
    (tmp_path / "head-bent-clean.json").write_text("no JSON")
    done = run_here("evaluate . --benchmark made", tmp_path)
    assert done.returncode == 2 and "head-bent-clean.json" in done.stderr
