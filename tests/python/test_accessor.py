"""mesh.symmetry on PyVista's data sets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import symsurf
from symsurf.mirror_operations.operate import operate

pyvista = pytest.importorskip("pyvista", "0.48", reason="needs PyVista 0.48 or later")
import symsurf.accessor  # an installed symsurf needs no import


def test_detect_is_symsurf_detect_on_the_mesh() -> None:
    mesh = pyvista.ParametricSuperEllipsoid(xradius=2, yradius=1, zradius=0.5)
    result = mesh.symmetry.detect("plane", pair_distance=0.1)
    expected = symsurf.detect(mesh, "plane", pair_distance=0.1)
    assert np.array_equal(result.mirror.normal, expected.mirror.normal)
    assert result.mirror.offset == expected.mirror.offset
    assert np.array_equal(result.faces, expected.faces)
    assert mesh.symmetry.result is result


def test_plot_takes_the_options_of_detect(tmp_path: Path) -> None:
    mesh = pyvista.Sphere().scale((3, 2, 1), inplace=False)
    mesh.symmetry.plot(tmp_path / "picture.png", method="plane", use_faces=False)
    assert mesh.symmetry.result.method == "plane"


@pytest.mark.parametrize("data", ["mesh", "cloud", "grid"])
def test_plot_draws_the_data_and_its_mirror(data: str, tmp_path: Path) -> None:
    mesh = pyvista.Sphere().scale((3, 2, 1), inplace=False)
    shape = {
        "mesh": mesh,
        "cloud": pyvista.PolyData(mesh.points),
        "grid": mesh.cast_to_unstructured_grid(),
    }[data]
    picture = tmp_path / "picture.png"
    shape.symmetry.plot(picture)
    pixels = np.asarray(pyvista.read(picture).active_scalars, dtype=float)
    drawn = np.abs(pixels - pixels[0]).max(axis=1) > 20
    assert 0.05 < drawn.mean() < 0.95


def test_errors_are_symsurfs() -> None:
    with pytest.raises(symsurf.InvalidInput, match="2 points"):
        pyvista.Line(resolution=1).symmetry.detect("plane")


@pytest.mark.parametrize("name", sorted(set(symsurf.operations()) - {"complete", "cut", "remesh"}))
def test_operations_give_meshes_with_arrays(name: str) -> None:
    mesh = pyvista.Sphere().scale((3, 2, 1), inplace=False)
    mesh["height"] = mesh.points[:, 2]
    plane = mesh.symmetry.detect("plane")
    made = getattr(mesh.symmetry, name)()
    expected = operate(name, mesh, plane)
    assert isinstance(made, pyvista.PolyData)
    np.testing.assert_allclose(made.points, expected.shape.points, atol=1e-6)  # float32
    assert np.array_equal(made.faces, mesh.faces)
    np.testing.assert_allclose(made["height"], mesh["height"], atol=1e-6)  # which is symmetric
    for array, values in expected.arrays.items():
        np.testing.assert_array_equal(made.point_data[array], values)
    for figure in expected.statistics:
        assert figure in made.field_data
    assert not set(expected.arrays) & set(mesh.array_names)


@pytest.mark.parametrize("name", sorted(set(symsurf.operations()) - {"complete"}))
def test_normals_stay_where_they_are_known(name: str) -> None:
    mesh = pyvista.Sphere().scale((3, 2, 1), inplace=False)
    mesh = mesh.compute_normals(cell_normals=True, point_normals=True)
    mesh.point_data["other"] = mesh.points[:, 0]
    mesh.symmetry.detect("plane")
    made = getattr(mesh.symmetry, name)()
    cells = not symsurf.operations()[name].moves_points
    points = cells or name in ("align", "cut", "remesh")  # go along with the points
    for data, stay in ((made.point_data, points), (made.cell_data, cells)):
        assert ("Normals" in data) == stay
        assert (data.active_normals is not None) == stay
    assert "other" in made.point_data and mesh.point_data.active_normals is not None


def test_operations_find_the_mirror_first_and_refuse_grids() -> None:
    mesh = pyvista.Sphere().scale((3, 2, 1), inplace=False)
    assert mesh.symmetry.asymmetry()["distance"].max() < 1e-5
    with pytest.raises(symsurf.InvalidInput, match="ImageData has none"):
        pyvista.ImageData(dimensions=(3, 3, 3)).symmetry.align()


@pytest.mark.parametrize("name", symsurf.analyses())
def test_analyses_give_meshes_with_arrays(name: str) -> None:
    mesh = pyvista.Sphere(theta_resolution=16, phi_resolution=16)
    mesh = mesh.scale((3, 2, 1), inplace=False)
    other = {"right": mesh} if symsurf.analyses()[name].takes_other else {}
    made = getattr(mesh.symmetry, name)(**other)
    found, expected = mesh.symmetry.analysis, getattr(symsurf, name)(mesh, **other)
    assert type(found) is type(expected)
    assert len(found.transformations) == len(expected.transformations)
    np.testing.assert_array_equal(made.points, mesh.points)
    for array, values in expected.arrays.items():
        np.testing.assert_array_equal(made.point_data[array], values)
    for figure, value in expected.statistics.items():
        np.testing.assert_array_equal(np.squeeze(made.field_data[figure]), np.squeeze(value))
    assert not set(expected.arrays) & set(mesh.array_names)
    grid = pyvista.ImageData(dimensions=(3, 3, 3))
    with pytest.raises(symsurf.InvalidInput, match=f"{name} takes .*ImageData has none"):
        getattr(grid.symmetry, name)()


def test_a_group_that_is_no_ascii() -> None:
    made = pyvista.Cylinder(resolution=400).symmetry.symmetries()
    assert made.field_data["group"][0] == "D∞h"


def test_complete_carries_attributes_to_what_it_adds() -> None:
    whole = pyvista.Icosphere(radius=1, nsub=4)
    whole["height"] = whole.points[:, 2]
    whole.cell_data["level"] = whole.cell_centers().points[:, 2]
    lost = (whole.points[:, 0] > 0.2) & (whole.points[:, 2] > -0.3)
    broken = whole.remove_points(ind=np.flatnonzero(lost))
    broken.symmetry.result = symsurf.match(broken, symsurf.Plane((1, 0, 0), 0))
    made = broken.symmetry.complete()
    assert isinstance(made, pyvista.PolyData)
    added = np.asarray(made["origin"]) > 0
    assert added.sum() > 0.5 * lost.sum() and not added[: broken.n_points].any()
    np.testing.assert_array_equal(made.points[: broken.n_points], broken.points)
    # The height is what the mirror leaves alone: of an image it is that of its source.
    np.testing.assert_allclose(made["height"], made.points[:, 2], atol=0.01)
    middle = made.cell_centers().points[:, 2]
    np.testing.assert_allclose(made.cell_data["level"], middle, atol=0.2)
    assert made.field_data["added_points"][0] == added.sum()
    cloud = pyvista.PolyData(broken.points)
    cloud["height"] = broken["height"]
    cloud.symmetry.result = broken.symmetry.result
    filled = cloud.symmetry.complete()
    np.testing.assert_allclose(filled["height"], filled.points[:, 2], atol=0.05)
    assert filled.n_points > cloud.n_points
