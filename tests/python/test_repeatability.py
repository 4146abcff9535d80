"""Standard deviations of the mirror over measurements of a part."""

import numpy as np
import pytest
from command_line import run_here
from symmetric_shapes import random_rotation

import symsurf

NOISE = 0.01
TURN, SHIFT = random_rotation(np.random.default_rng(0)), (1, 2, 3)


def measured(seed, count=1500):
    """Other points of the surface of one part, each with an error of its own."""
    rng = np.random.default_rng([7, seed])
    d = rng.normal(size=(count, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    bumps = 0.25 * np.sin(3 * d[:, 1] + 0.5) + 0.2 * d[:, 2] + 0.15 * np.abs(d[:, 0]) * d[:, 2]
    points = d * (1 + bumps)[:, None] * (1, 0.9, 0.7)
    return (points + NOISE * rng.normal(size=points.shape)) @ TURN.T + SHIFT


@pytest.fixture(scope="module")
def truth():
    return symsurf.repeatability(map(measured, range(40)), method="plane", asymmetry=False)


def mean_of(found, name):
    return np.sqrt(np.mean([each[name] ** 2 for each in found]))


def test_ten_measurements_show_the_deviation_of_many(truth):
    """Of one series of ten the deviation is off by a fifth by chance alone: four series."""
    series = [
        symsurf.repeatability(
            (measured(1000 + 10 * k + i) for i in range(10)), method="plane", asymmetry=False
        )
        for k in range(4)
    ]
    for name in ("angle_sd", "offset_sd"):
        assert mean_of(series, name) == pytest.approx(truth[name], rel=1 / 3), name


def test_halves_of_one_measurement_show_at_most_thrice_the_deviation_of_many(truth):
    found = [symsurf.detect(measured(i), "plane", repeat=8).statistics for i in range(4)]
    for name in ("angle_sd", "offset_sd"):
        assert truth[name] / 1.5 < mean_of(found, name) < 3 * truth[name], name
    assert all(each["repeats"] == 8 and each["score_sd"] > 0 for each in found)


def test_deviations_of_known_mirrors():
    """Planes turned by 1 and -1 degree and shifted by 0.1 and -0.1 against the mean."""
    shape = measured(0)
    angle = np.radians(1)
    planes = [
        symsurf.Plane((np.cos(a), np.sin(a), 0), -(np.cos(a) * c[0] + np.sin(a) * c[1]) + s)
        for a, s in ((angle, 0.1), (-angle, -0.1))
        for c in [shape.mean(axis=0)]
    ]
    planes[1] = symsurf.Plane(-planes[1].normal, -planes[1].offset)  # which side is which is chance
    measurements = [symsurf.detection.repeating.Measurement(plane, 0.9) for plane in planes]
    found = symsurf.detection.repeating.deviations(measurements, shape)
    assert found["angle_sd"] == pytest.approx(np.sqrt(2))
    assert found["offset_sd"] == pytest.approx(np.std([0.1, -0.1], ddof=1))
    assert found["score_sd"] == 0 and "rms_sd" not in found


def test_the_asymmetry_has_the_deviation_of_its_rms():
    shape = measured(0, 600)
    found = symsurf.detect(shape, "plane")
    made = symsurf.asymmetry(shape, found, repeat=4)
    assert 0 < made.statistics["rms_sd"] < made.statistics["rms"]
    again = symsurf.asymmetry(shape, method="plane", repeat=4)
    assert again.statistics["angle_sd"] == made.statistics["angle_sd"]
    with pytest.raises(symsurf.InvalidParameter, match="repeat is given beside a mirror"):
        symsurf.asymmetry(shape, found.mirror, repeat=4)
    with pytest.raises(symsurf.InvalidParameter, match="repeat is 1; allowed is 0 or"):
        symsurf.detect(shape, repeat=1)


def test_the_command_line_tells_them_for_one_file_and_for_several(tmp_path):
    for i in range(3):
        np.savetxt(tmp_path / f"{i}.xyz", measured(i, 600))
    told = run_here("asymmetry 0.xyz --method plane --repeat 3", tmp_path)
    assert told.returncode == 0 and "rms sd" in told.stdout, told.stderr
    told = run_here("detect 0.xyz 1.xyz 2.xyz --method plane --one-part --repeat 3", tmp_path)
    assert told.returncode == 0 and "repeats   repeats 3" in told.stdout, told.stderr
    last = told.stdout.splitlines()[-1]
    assert last.startswith("3 files of one part:  repeats 3  angle_sd ")
    wanted = symsurf.repeatability([tmp_path / f"{i}.xyz" for i in range(3)], method="plane")
    assert float(last.split("angle_sd ")[1].split()[0]) == pytest.approx(
        wanted["angle_sd"], rel=1e-4
    )
