"""Light on mirrors against brute force and against rays that are cast."""

import pytest
from accuracy.light import CASES
from accuracy.quadric_paths import KINDS

CASE = {case.name: case for case in CASES}


@pytest.mark.parametrize("kind", KINDS)
def test_reflection_points_of_quadrics_are_those_of_brute_force(kind):
    for seed in range(2):
        figures = CASE["light, points of quadrics against brute force"].trial(kind, seed)
        assert figures["all found"] and figures["none false"]


def test_irradiance_is_what_cast_rays_count():
    pytest.importorskip("vtk")
    assert CASE["light, irradiance against ray casting"].trial("sphere", 0)["off"] <= 0.02
