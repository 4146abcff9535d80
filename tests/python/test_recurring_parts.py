"""The parts of meshes and clouds that recur, against what they are made to have."""

from __future__ import annotations

import json

import numpy as np
import pytest
from accuracy.repeated import facade, gear
from accuracy.solids import sampled
from seeds import each_seed
from symmetric_shapes import random_rotation

import symsurf


def posed(points, seed):
    rng = np.random.default_rng(seed)
    return 3 * points @ random_rotation(rng).T + rng.normal(size=3)


@each_seed
@pytest.mark.parametrize("bars", [False, True])
def test_a_facade_has_its_windows_with_or_without_bars(seed, bars):
    points, faces, window = facade(4, 6, np.random.default_rng(seed), bars=bars)
    found = symsurf.recurring_parts(posed(points, seed), faces=faces)
    (part,) = found.parts
    assert len(part) == 24
    assert {each.kind for each in part} == {"identity", "translation"}
    # A number for each window, and the same for all of its points: panes, too.
    instance = found.arrays["instance"]
    for k in range(24):
        assert len(set(instance[window == k])) == 1
    assert len(set(instance[window >= 0])) == 24
    assert (instance[window < 0] == -1).all() and (found.arrays["part"][window >= 0] == 0).all()


@each_seed
def test_two_gears_have_the_teeth_of_both(seed):
    rng = np.random.default_rng(seed)
    (small, small_faces, _), (large, large_faces, _) = gear(7, rng), gear(24, rng)
    points = np.vstack([small, large + (3, 0, 1)])
    faces = np.vstack([small_faces, large_faces + len(small)])
    found = symsurf.recurring_parts(posed(points, seed), faces=faces)
    assert sorted(len(part) for part in found.parts) == [7, 24]
    assert {each.kind for each in found.transformations} == {"identity", "rotation"}


def test_what_is_found_is_told():
    points, faces, _ = facade(2, 3, np.random.default_rng(0))
    found = symsurf.recurring_parts(points, faces=faces)
    assert "instances of each part: 6" in repr(found)
    told = json.loads(json.dumps(found.to_json()))
    assert told["statistics"]["parts"] == 1 and told["statistics"]["instances"] == 6
    assert [each["kind"] for each in told["transformations"]] == ["identity"] + ["translation"] * 5
    for each in found.parts[0]:
        images = points[each.from_points] @ each.matrix[:3, :3].T + each.matrix[:3, 3]
        low, high = images.min(axis=0), images.max(axis=0)
        np.testing.assert_allclose(low, points[each.onto_points].min(axis=0), atol=1e-9)
        np.testing.assert_allclose(high, points[each.onto_points].max(axis=0), atol=1e-9)


@each_seed
def test_a_cloud_has_its_windows(seed):
    rng = np.random.default_rng(seed)
    points, faces, _ = facade(2, 3, rng)
    cloud = posed(sampled(points, faces, 60000, rng), seed)
    found = symsurf.recurring_parts(cloud)
    (part,) = found.parts
    assert [each.kind for each in part] == ["identity"] + ["translation"] * 5
    assert "instances of each part: 6" in repr(found)


@each_seed
def test_noise_of_a_mesh_is_told_and_hides_no_window(seed):
    rng = np.random.default_rng(seed)
    points, faces, window = facade(2, 3, rng)
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    noise = 5e-4 * diagonal
    found = symsurf.recurring_parts(points + noise * rng.normal(size=points.shape), faces=faces)
    assert 0.7 * noise < found.statistics["noise"] < 1.5 * noise
    (part,) = found.parts
    owners = [set(window[each.onto_points]) - {-1} for each in part]
    assert sorted(owners, key=min) == [{k} for k in range(6)]
