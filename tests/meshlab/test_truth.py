"""What the filters find is the mirror the shape was made with."""

from __future__ import annotations

import numpy as np
import pytest
from shapes import SURFACES, lump_cloud


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", SURFACES)
def test_the_plane_is_the_true_one(kind, seed):
    shape = SURFACES[kind](seed)
    returned = shape.mesh_set().apply_filter("compute_mirror_plane")
    sign = np.sign(returned["normal"] @ shape.normal)
    assert np.allclose(sign * returned["normal"], shape.normal, rtol=0, atol=1e-9)
    assert returned["offset"] * sign == pytest.approx(shape.offset, abs=1e-9 * shape.diagonal)
    assert returned["score"] > 0.9


def test_the_matrix_maps_the_shape_to_itself():
    shape = lump_cloud(1)
    matrix = shape.mesh_set().apply_filter("compute_mirror_plane")["matrix"]
    images = shape.points @ matrix[:3, :3].T + matrix[:3, 3]
    gaps = np.linalg.norm(images[:, None] - shape.points[None], axis=-1).min(axis=1)
    assert gaps.max() < 1e-9 * shape.diagonal


def test_vertices_without_partner_are_grey():
    shape = lump_cloud(7)
    shape.points[0] = shape.points.mean(axis=0) + shape.diagonal * shape.normal
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_mirror_plane")
    marked = mesh_set[0]
    partner = marked.vertex_custom_scalar_attribute_array("partner")
    colours = marked.vertex_color_matrix()
    assert partner[0] == -1 and marked.vertex_scalar_array()[0] == -1
    grey = np.ptp(colours[:, :3], axis=1) == 0
    assert np.array_equal(grey, partner < 0)
