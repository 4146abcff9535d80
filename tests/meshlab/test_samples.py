"""create_mirror_sample against the generators it is made from."""

from __future__ import annotations

import numpy as np
import pymeshlab
import pytest
from shapes import cloud

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")

FILTER = "create_mirror_sample"
REFUSALS = (pymeshlab.PyMeshLabException, pymeshlab.InvalidEnumException)
GENERATORS = ("fixed", "perpendicular", "spherical")


@pytest.mark.parametrize("generator", GENERATORS)
def test_pairs_are_mirrored_over_the_true_mirror(generator):
    mesh_set = cloud().mesh_set()
    returned = mesh_set.apply_filter(FILTER, generator=generator, resolution=12)
    sample = mesh_set.current_mesh()
    assert sample.label() == "Sample" and sample.id() == returned["sample_layer"]
    partner = sample.vertex_custom_scalar_attribute_array("partner").astype(int)
    paired = np.flatnonzero(partner >= 0)
    assert len(paired) > 50 and np.array_equal(partner[partner[paired]], paired)

    # Over the true mirror the first halves of the pairs fall on the second ones.
    reflected = mesh_set.apply_filter(
        "apply_mirror_reflection", mirror_layer=returned["mirror_layer"]
    )
    points = sample.vertex_matrix()
    images = mesh_set[reflected["reflection_layer"]].vertex_matrix()
    assert len(images) == len(points)
    first = paired[paired < partner[paired]]
    gaps = np.linalg.norm(images[first] - points[partner[first]], axis=1)
    assert gaps.max() < 1e-9 * np.linalg.norm(np.ptp(points, axis=0))


def test_the_current_layer_can_be_mirrored():
    shape = cloud(3)
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter(FILTER, generator="spherical", use_current_layer=True, radius_divisor=1.5)
    points = mesh_set.current_mesh().vertex_matrix()
    inside = np.linalg.norm(shape.points, axis=1) < shape.diagonal / 1.5
    assert len(points) <= 2 * inside.sum()
    assert {tuple(p) for p in points[: len(points) // 2]} <= {tuple(p) for p in shape.points}


def test_bad_parameters():
    for parameters, sentence in (
        ({"resolution": 1}, "resolution is 1; allowed is integer"),
        ({"generator": "perpendicular", "use_current_layer": True}, "makes its points itself"),
        ({"generator": "no such thing"}, "no such thing"),
    ):
        mesh_set = cloud().mesh_set()
        with pytest.raises(REFUSALS, match=sentence):
            mesh_set.apply_filter(FILTER, **parameters)
        assert len(mesh_set) == 1
