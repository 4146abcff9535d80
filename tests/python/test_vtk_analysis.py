"""The analyses as a filter of the vtk package that pip installs."""

from __future__ import annotations

import numpy as np
import pytest

import symsurf

pytest.importorskip("vtkmodules", reason="needs the vtk package")

from vtk_data import array, error_of, mirrored_shape, polydata
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkCubeSource

from symsurf.vtk import SymmetryAnalysis


def box():
    source = vtkCubeSource(x_length=4, y_length=3, z_length=2)
    source.Update()
    return source.GetOutput()


def test_gives_what_the_core_gives() -> None:
    points = mirrored_shape()
    expected = symsurf.symmetries(points)
    found = SymmetryAnalysis(input_data=polydata(points))
    assert error_of(found) == ""
    field = found.output.GetFieldData()
    assert field.GetAbstractArray("Analysis").GetValue(0) == "symmetries"
    assert field.GetAbstractArray("Group").GetValue(0) == expected.group == "Cs"
    elements = found.GetOutput(SymmetryAnalysis.ELEMENTS)
    vertices = vtk_to_numpy(elements.GetPoints().GetData())
    assert np.abs(expected.planes[0].signed_distance(vertices)).max() < 1e-9
    transformations = found.GetOutput(SymmetryAnalysis.TRANSFORMATIONS)
    matrices = array(transformations, "Matrix").reshape(-1, 4, 4)
    np.testing.assert_array_equal(matrices, expected.elements)
    kinds = transformations.GetPointData().GetAbstractArray("Kind")
    assert [kinds.GetValue(i) for i in range(2)] == ["identity", "reflection"]


def test_axes_are_lines_with_their_order() -> None:
    found = SymmetryAnalysis(input_data=box())
    assert error_of(found) == ""
    elements = found.GetOutput(SymmetryAnalysis.ELEMENTS)
    assert elements.GetNumberOfLines() == 3
    data = elements.GetCellData()
    kinds = data.GetAbstractArray("ElementKind")
    count = elements.GetNumberOfCells()
    assert kinds.GetNumberOfValues() == count
    assert [kinds.GetValue(i) for i in (0, count - 1)] == ["axis", "plane"]
    assert vtk_to_numpy(data.GetArray("ElementOrder")).tolist() == [2] * count


def test_bad_input_is_an_error_of_the_filter() -> None:
    filter_ = SymmetryAnalysis(input_data=polydata(np.zeros((5, 3))))
    assert "all 5 points are equal" in error_of(filter_)
    filter_ = SymmetryAnalysis(input_data=box(), analysis="symmetrie")
    assert "there is no analysis 'symmetrie'" in error_of(filter_)
    filter_ = SymmetryAnalysis(input_data=box(), symmetries_minimum_score=2)
    assert "minimum_score is 2; allowed is real [0, 1]" in error_of(filter_)
    with pytest.raises(AttributeError, match="nearest"):
        filter_.symmetries_minimum_scores = 0.5


@pytest.mark.parametrize("name", symsurf.analyses())
def test_every_analysis_runs(name: str) -> None:
    described = symsurf.analyses()[name]
    found = SymmetryAnalysis(input_data=box(), analysis=name)
    if described.takes_other:
        found.other_data = box()
    assert error_of(found) == ""
    given = box().GetPointData().GetNumberOfArrays()
    assert found.output.GetPointData().GetNumberOfArrays() == given + len(described.arrays)
