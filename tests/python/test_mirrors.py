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


def every_kind():
    points = np.random.default_rng(0).uniform(-1, 1, size=(300, 3)) * (1, 1, 0.1)
    nodes = np.column_stack([points[:, :2], 0.1 * points[:, 0] ** 2])
    bowl = {"centres": [[0, 0, 0]], "tangents": [[1, 0, 0]], "normals": [[0, 0, 1]],
            "heights": [[0, 0, 0, 0.1, 0, 0.1]], "radii": [[3.0]]}  # fmt: skip
    known = symsurf.make_mirror(
        "surface",
        {"surface": "f1", "mapping": "fixed", "scale": 1.0, "rotation": np.eye(3),
         "translation": np.zeros(3)},
        footprint=points,
    )  # fmt: skip
    free = symsurf.make_mirror(
        "free-form", {name: np.array(rows, float) for name, rows in bowl.items()}
    )
    return [
        symsurf.Plane((0, 0, 1), 0),
        symsurf.Sphere((0, 0, -5), 5),
        symsurf.Cylinder((0, 0, -5), (1, 0, 0), 5),
        symsurf.Quadric(np.diag([0.1, 0.1, 0]), (0, 0, -1), 0),
        symsurf.HeightField((0, 0, 1), nodes),
        free,
        known,
    ]


@pytest.mark.parametrize("mirror", every_kind(), ids=lambda mirror: mirror.kind)
def test_every_kind_reflects_light(mirror):
    sources = np.array([[0.3, 0.2, 2.0], [-0.4, 0.1, 1.5]])
    eye = np.array([0.1, -0.3, 1.7])
    found = mirror.reflection_points(sources, eye)
    assert len(found) == len(found.positions) == len(found.sources) and len(found) >= 2
    assert set(found.sources) == {0, 1}
    to_source, to_eye = sources[found.sources] - found.positions, eye - found.positions
    lengths = [np.linalg.norm(each, axis=1) for each in (to_source, to_eye)]
    np.testing.assert_allclose(found.path_lengths, sum(lengths), rtol=1e-14)
    assert np.all(found.irradiance > 0)
    # Equal angles with the surface, whose feet near the point lie across both their sum.
    half = to_source / lengths[0][:, None] + to_eye / lengths[1][:, None]
    for shift in 1e-6 * np.eye(3)[:2]:
        ahead = mirror.project(found.positions + shift) - mirror.project(found.positions - shift)
        assert np.all(np.abs(np.sum(half * ahead, axis=1)) <= 1e-6 * np.linalg.norm(ahead, axis=1))
    first = mirror.reflection_points(sources[0], list(eye))
    np.testing.assert_array_equal(first.positions, found.positions[found.sources == 0])


def test_light_reports_progress_and_is_cancelled():
    sphere, sources = symsurf.Sphere((0, 0, 0), 1), np.random.default_rng(0).normal(size=(2000, 3))
    seen = []
    for threads in (1, 2):
        sphere.reflection_points(sources, (1, 2, 3), threads=threads, progress=seen.append)
    assert seen and min(seen) >= 0 and max(seen) <= 1
    with pytest.raises(symsurf.Cancelled):
        sphere.reflection_points(sources, (1, 2, 3), progress=lambda fraction: False)
    with pytest.raises(symsurf.InvalidParameter):
        sphere.reflection_points(sources, (1, 2, 3), threads=-1)


def test_light_is_refused_where_it_is_no_point():
    sphere = symsurf.Sphere((0, 0, 0), 1)
    for source, eye in [((1, 2), (1, 2, 3)), ((1, 2, 3), (1, 2)), ((np.nan, 0, 0), (1, 2, 3)),
                        ((1, 2, 3), (1, 2, np.inf)), (np.zeros((2, 2, 3)), (1, 2, 3))]:  # fmt: skip
        with pytest.raises(symsurf.InvalidInput):
            sphere.reflection_points(source, eye)
    assert len(sphere.reflection_points(np.zeros((0, 3)), (1, 2, 3))) == 0
    assert len(sphere.reflection_points((0, 0, 0), (0, 0, 0))) == 0


def test_numbers_beyond_a_double_are_infinite():
    numbers = {"normal": np.array([0, 0, 1.0]), "offset": 10**400}
    with pytest.raises(symsurf.InvalidInput, match="inf"):
        symsurf._core.make_mirror("plane", numbers)
