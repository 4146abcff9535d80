"""What may be given for points, and that nothing is copied that need not be."""

from __future__ import annotations

import copy
import gc
import pickle
from types import SimpleNamespace

import numpy as np
import pytest

import symsurf

RESULT_ARRAYS = "surface_points", "pairs", "residuals"


class ArrayInterface:
    """Like a tensor or a data frame."""

    def __init__(self, array):
        self._array = array

    def __array__(self, dtype=None, copy=None):
        return self._array if dtype is None else self._array.astype(dtype)


def match(points) -> symsurf.Result:
    return symsurf.match(points, symsurf.Plane((1, 0, 0), 0))


def address(array: np.ndarray) -> int:
    return array.__array_interface__["data"][0]


def test_doubles_are_read_in_place(blob):
    assert match(blob).points is blob
    assert symsurf.detect_plane(blob).points is blob


def test_read_only_and_mapped_memory_is_read_in_place(blob, tmp_path):
    blob.setflags(write=False)
    assert address(match(blob).points) == address(blob)
    np.save(tmp_path / "points.npy", blob)
    mapped = np.load(tmp_path / "points.npy", mmap_mode="r")
    assert address(match(mapped).points) == address(mapped)


@pytest.mark.parametrize(
    "given",
    [
        lambda p: p.astype(np.float32),
        lambda p: p.astype(">f8"),
        lambda p: np.asfortranarray(p),
        lambda p: np.repeat(p, 2, axis=0)[::2],
        lambda p: p.tolist(),
        lambda p: tuple(map(tuple, p)),
        lambda p: p.astype(object),
        lambda p: ArrayInterface(p),
        lambda p: SimpleNamespace(points=p),
        lambda p: SimpleNamespace(vertices=p),
        lambda p: symsurf.Shape(p),
        lambda p: memoryview(p),
    ],
)
def test_anything_array_like(given, blob):
    blob = blob.astype(np.float32).astype(np.float64)
    result, expected = match(given(blob)), match(blob)
    np.testing.assert_array_equal(result.points, blob)
    np.testing.assert_array_equal(result.residuals, expected.residuals)


def test_integers():
    grid = np.stack(np.meshgrid(range(4), range(5), range(6)), axis=-1).reshape(-1, 3)
    assert symsurf.match(grid, symsurf.Plane((1, 0, 0), -1.5)).residuals.max() == 0


def test_result_arrays_are_the_cores_memory(blob):
    result = match(blob)
    for name in RESULT_ARRAYS:
        array = getattr(result, name)
        assert not array.flags.owndata and type(array.base).__name__ == "PyCapsule"
        assert array is getattr(result, name)
    assert result.pairs.dtype == np.int64
    assert result.surface_points.shape == (len(result.pairs), 3)
    assert result.residuals.shape == (len(result.pairs),)


def test_result_arrays_outlive_the_result(blob):
    result = match(blob)
    arrays = [getattr(result, name) for name in RESULT_ARRAYS]
    copies = [array.copy() for array in arrays]
    del result
    gc.collect()
    [np.empty(array.shape) for array in arrays * 20]  # would take freed memory
    for array, expected in zip(arrays, copies):
        np.testing.assert_array_equal(array, expected)


def test_results_can_be_pickled_and_copied(blob):
    result = symsurf.detect_plane(blob)
    for twin in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
        assert repr(twin) == repr(result)
        np.testing.assert_array_equal(twin.pairs, result.pairs)
        np.testing.assert_array_equal(twin.mirror.mesh()[0], result.mirror.mesh()[0])
