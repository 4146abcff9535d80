"""Mirrors made by hand."""

from __future__ import annotations

import numpy as np
import pytest
from symmetric_shapes import random_rotation

import symsurf

MIRRORS = [
    symsurf.Plane((1, 2, -2), 3),
    symsurf.Sphere((0.5, -1, 2), 8),
]


@pytest.mark.parametrize("mirror", MIRRORS, ids=lambda mirror: mirror.kind)
def test_one_meaning_of_reflecting(mirror, blob):
    images, feet = mirror.reflect(blob), mirror.project(blob)
    np.testing.assert_allclose(images, blob + 2 * (feet - blob), atol=1e-12)
    np.testing.assert_allclose(mirror.reflect(images), blob, atol=1e-12)
    np.testing.assert_allclose(mirror.signed_distance(feet), 0, atol=1e-12)
    np.testing.assert_allclose(mirror.signed_distance(images), -mirror.signed_distance(blob))
    np.testing.assert_allclose(
        np.abs(mirror.signed_distance(blob)), np.linalg.norm(feet - blob, axis=1)
    )


@pytest.mark.parametrize("mirror", MIRRORS, ids=lambda mirror: mirror.kind)
def test_mesh_lies_on_the_mirror(mirror, blob):
    vertices, triangles = mirror.mesh(blob, resolution=9)
    assert vertices.dtype == np.float64 and triangles.dtype == np.int64
    assert 0 <= triangles.min() and triangles.max() < len(vertices)
    np.testing.assert_allclose(mirror.signed_distance(vertices), 0, atol=1e-12)


@pytest.mark.parametrize("mirror", MIRRORS, ids=lambda mirror: mirror.kind)
def test_numbers_make_the_mirror_again(mirror, blob):
    again = symsurf.make_mirror(mirror.kind, mirror.numbers)
    assert type(again) is type(mirror)
    np.testing.assert_array_equal(again.reflect(blob), mirror.reflect(blob))
    for name, value in mirror.numbers.items():
        np.testing.assert_array_equal(getattr(mirror, name), value)
        assert f"{name}=" in repr(mirror)


def test_plane_matrix(blob, rng):
    plane = symsurf.Plane(random_rotation(rng)[0] * 3, 2)
    assert np.linalg.norm(plane.normal) == pytest.approx(1)
    assert plane.offset == pytest.approx(2 / 3)
    assert plane.matrix.shape == (4, 4)
    homogeneous = np.c_[blob, np.ones(len(blob))]
    np.testing.assert_allclose((homogeneous @ plane.matrix.T)[:, :3], plane.reflect(blob))
    np.testing.assert_allclose(plane.matrix @ plane.matrix, np.eye(4), atol=1e-12)


def test_sphere_has_no_image_beyond_twice_its_radius():
    sphere = symsurf.Sphere((0, 0, 0), 1)
    images = sphere.reflect([(0.5, 0, 0), (2.5, 0, 0), (0, 0, 0)])
    np.testing.assert_allclose(images[0], (1.5, 0, 0))
    assert np.isnan(images[1:]).all()
