"""Masks and images: the points that detect takes of them."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
from symmetric_shapes import is_near, random_rotation

import symsurf


def body(shape=(31, 36, 26)):
    """A grid of numbers above 1 within a body whose only mirror is x = 12."""
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.ImageData(dimensions=shape)
    x, y, z = (np.asarray(grid.points) - (12, 17, 12)).T
    ball = 1 - (x / 9) ** 2 - (y / 15) ** 2 - (z / 7) ** 2
    arm = 1 - ((abs(x) - 6) / 4) ** 2 - ((y - 8) / 4) ** 2 - ((z - 5) / 6) ** 2
    grid["density"] = 1 + np.maximum(ball, arm) - 0.01
    return grid


MIRROR = np.array([1.0, 0, 0]), np.array([12.0, 0, 0])
HALF_A_CELL = 0.51


def test_an_image_is_the_points_above_the_threshold():
    grid = body()
    result = (
        grid.symmetry.detect("plane", threshold=1)
        if hasattr(grid, "symmetry")
        else (symsurf.detect(grid, "plane", threshold=1))
    )
    expected = np.asarray(grid.points)[grid["density"] > 1]
    np.testing.assert_array_equal(result.points, expected)
    assert is_near(result.mirror, *MIRROR, within=HALF_A_CELL) and result.faces is None
    assert result.pairs.max() < len(expected)
    by_name = symsurf.detect(grid, "plane", threshold=1, scalars="density")
    assert repr(by_name.mirror) == repr(result.mirror)


@pytest.mark.parametrize("mask", ["bool", "uint8", "float32", "labels"])
def test_a_mask_needs_no_threshold(mask):
    grid = body()
    inside = grid["density"] > 1
    grid["mask"] = {
        "bool": inside,
        "uint8": inside.astype(np.uint8),
        "float32": inside.astype(np.float32),
        "labels": 3 + 4 * inside,
    }[mask]
    grid.set_active_scalars("mask")
    result = symsurf.detect(grid, "plane")
    assert len(result.points) == inside.sum() and is_near(
        result.mirror, *MIRROR, within=HALF_A_CELL
    )


def test_cells_are_their_centres():
    grid = body()
    centres = grid.point_data_to_cell_data()
    centres.set_active_scalars("density")
    result = symsurf.detect(centres, "plane", threshold=1)
    inside = np.asarray(centres.cell_data["density"]) > 1
    np.testing.assert_allclose(result.points, centres.cell_centers().points[inside])
    assert is_near(result.mirror, *MIRROR, within=HALF_A_CELL)


@pytest.mark.parametrize("of_cells", [False, True])
@pytest.mark.parametrize("kind", ["image", "flat image", "rectilinear", "flat rectilinear"])
def test_points_of_grids_are_where_pyvista_has_them(kind, of_cells):
    """They are made of their indices: those of all voxels would take 24 bytes each."""
    pyvista = pytest.importorskip("pyvista")
    from symsurf.base.options import Reading
    from symsurf.shapes.grids import chosen_points

    rng = np.random.default_rng(4)
    shape = (5, 1, 7) if "flat" in kind else (5, 6, 7)
    if "image" in kind:
        grid = pyvista.ImageData(
            dimensions=shape,
            spacing=(0.3, 2, 1.7),
            origin=(10, -200, 3),
            offset=(4, -3, 11),
            direction_matrix=random_rotation(rng),
        )
    else:
        grid = pyvista.RectilinearGrid(*(np.sort(rng.normal(size=n)) for n in shape))
    data, count = (grid.cell_data, grid.n_cells) if of_cells else (grid.point_data, grid.n_points)
    data["value"] = rng.normal(size=count)
    expected = grid.cell_centers().points if of_cells else grid.points
    chosen = np.asarray(data["value"]) > 0.2
    points = chosen_points(grid, Reading(threshold=0.2, scalars="value"))
    assert points.flags.c_contiguous and points.dtype == float
    np.testing.assert_allclose(points, expected[chosen], rtol=1e-12, atol=1e-12)


def test_few_points_of_a_large_image_take_little_memory():
    pyvista = pytest.importorskip("pyvista")
    from symsurf.base.options import Reading
    from symsurf.shapes.grids import chosen_points

    image = pyvista.ImageData(dimensions=(200, 200, 200))
    values = np.zeros(image.n_points, np.uint8)
    values[[5, 77, 7_000_000]] = 1
    image["value"] = values
    tracemalloc.start()
    try:
        assert len(chosen_points(image, Reading(scalars="value"))) == 3
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 8 * len(values)


@pytest.mark.parametrize("kind", ["rectilinear", "structured", "flat"])
def test_every_regular_grid(kind):
    pyvista = pytest.importorskip("pyvista")
    grid = body()
    if kind == "flat":
        x, y = np.meshgrid(np.arange(40.0), np.arange(50.0), indexing="ij")
        grid = pyvista.StructuredGrid(x, y, 0 * x)
        grid["density"] = 2 - ((grid.points[:, 0] - 12) / 9) ** 2 - (grid.points[:, 1] / 40) ** 3
    else:
        grid = {
            "rectilinear": lambda: grid.cast_to_rectilinear_grid(),
            "structured": lambda: grid.cast_to_structured_grid().rotate_z(0),
        }[kind]()
    result = symsurf.detect(grid, "plane", threshold=1, scalars="density")
    assert len(result.points) == (grid["density"] > 1).sum()
    assert is_near(result.mirror, *MIRROR, within=HALF_A_CELL)
    grid.clear_data()
    with pytest.raises(symsurf.InvalidInput, match="scalars=NAME"):
        symsurf.detect(grid, "plane")


def test_never_the_symmetry_of_the_grid_itself():
    grid = body()
    with pytest.raises(symsurf.InvalidInput, match="give threshold=NUMBER"):
        symsurf.detect(grid)
    with pytest.raises(symsurf.InvalidInput, match="above threshold=99; they end at"):
        symsurf.detect(grid, threshold=99)
    with pytest.raises(symsurf.InvalidInput, match="scalars='none' are not there.*'density'"):
        symsurf.detect(grid, threshold=1, scalars="none")
    with pytest.raises(symsurf.InvalidParameter, match="threshold is 'high'"):
        symsurf.detect(grid, threshold="high")
    grid["all"] = np.ones(grid.n_points, np.uint8)
    with pytest.raises(symsurf.InvalidInput, match="threshold=NUMBER"):
        symsurf.detect(grid, scalars="all")
    grid["vectors"] = np.ones((grid.n_points, 3))
    with pytest.raises(symsurf.InvalidInput, match="'vectors' have shape"):
        symsurf.detect(grid, scalars="vectors", threshold=0)
