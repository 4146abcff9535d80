"""MirrorDetection in the vtk package that pip installs: ports, arrays, errors, pipelines."""

from __future__ import annotations

import gc

import numpy as np
import pytest

import symsurf

pytest.importorskip("vtkmodules", reason="needs the vtk package")

from bad_input import tables
from vtk_data import PLANE, array, error_of, mirrored_shape, polydata
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkTable
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkSphereSource

from symsurf.vtk import MirrorDetection


def detection(points: np.ndarray, method: str = "plane") -> MirrorDetection:
    found = MirrorDetection()
    found.SetInputData(polydata(points))
    found.SetMethod(method)
    return found


@pytest.mark.parametrize("method", symsurf.methods())
def test_every_method_gives_what_symsurf_detect_gives(method: str) -> None:
    points = mirrored_shape()
    if method == "sphere_thesis":
        points = points[::6]  # its work grows with their cube
    found = detection(points, method)
    found.Update()
    gc.collect()  # the arrays own what they show
    expected = symsurf.detect(points, method)

    shape, mirror, surface = (found.GetOutput(port) for port in range(3))
    fields = mirror.GetFieldData()
    assert fields.GetArray("Score").GetValue(0) == expected.score
    assert fields.GetAbstractArray("Method").GetValue(0) == expected.method
    if expected.mirror is not None:
        assert fields.GetAbstractArray("Kind").GetValue(0) == expected.mirror.kind
        vertices, triangles = expected.mirror.mesh()
        assert np.array_equal(vtk_to_numpy(mirror.GetPoints().GetData()), vertices)
        corners = vtk_to_numpy(mirror.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        assert np.array_equal(corners, triangles)
        sides = array(shape, "MirrorSide")
        assert np.all(sides * np.nan_to_num(expected.mirror.signed_distance(points)) >= 0)

    assert np.array_equal(vtk_to_numpy(surface.GetPoints().GetData()), expected.surface_points)
    assert np.array_equal(array(surface, "Residual"), expected.residuals)
    assert surface.GetNumberOfVerts() == len(expected.surface_points)
    paired = np.isin(np.arange(len(points)), expected.pairs[:, 0])
    assert np.array_equal(array(shape, "MirrorPartner") >= 0, paired)
    residuals = array(shape, "MirrorResidual")
    assert np.array_equal(np.isfinite(residuals), paired)
    if paired.any():
        p99 = shape.GetFieldData().GetArray("MirrorResidualP99").GetValue(0)
        assert p99 in residuals and np.mean(residuals[paired] > p99) <= 0.01
        assert np.mean(residuals[paired] >= p99) >= 0.01


def test_known_plane() -> None:
    found = detection(mirrored_shape(2000))
    found.Update()
    vertices = vtk_to_numpy(found.GetOutput(found.MIRROR).GetPoints().GetData())
    assert np.abs(PLANE.signed_distance(vertices)).max() < 1e-9


def test_setters_are_the_descriptions() -> None:
    found = MirrorDetection()
    assert found.GetMethod() == "auto"
    for method in symsurf.methods().values():
        for parameter in method.parameters:
            words = f"{method.name}_{parameter.name}".split("_")
            name = "".join(word.capitalize() for word in words)
            assert np.array_equal(getattr(found, f"Get{name}")(), parameter.default)
            assert parameter.doc in getattr(found, f"Set{name}").__doc__


def test_properties_are_the_descriptions() -> None:
    found = MirrorDetection()
    assert found.method == "auto"
    found.method = "plane"
    assert found.GetMethod() == "plane"
    for method in symsurf.methods().values():
        for parameter in method.parameters:
            name = f"{method.name}_{parameter.name}"
            assert np.array_equal(getattr(found, name), parameter.default)
            assert parameter.doc in getattr(MirrorDetection, name).__doc__
            setattr(found, name, parameter.default)
    before = found.GetMTime()
    found.plane_pair_distance = 0.125
    assert found.GetPlanePairDistance() == 0.125 and found.GetMTime() > before


def test_properties_are_keywords_of_the_constructor() -> None:
    shape = mirrored_shape()
    found = MirrorDetection(
        input_data=polydata(shape), method="plane", plane_pair_distance=0, number_of_threads=1
    )
    found.Update()
    assert np.nanmax(array(found.output, "MirrorResidual"), initial=0) < 1e-12
    assert found.GetOutput(1).GetFieldData().GetAbstractArray("Method").GetValue(0) == "plane"
    for method in symsurf.methods().values():
        for parameter in method.parameters:
            name = f"{method.name}_{parameter.name}"
            made = MirrorDetection(**{name: parameter.default})
            assert np.array_equal(getattr(made, name), parameter.default)


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("metod", "has no attribute 'metod'; nearest: method"),
        ("Method", "has no attribute 'Method'; nearest: method"),
        ("plane_pair_distanc", "nearest: plane_pair_distance"),
        ("pair_distance", "nearest: plane_pair_distance"),
        ("UseNormals", "nearest: use_normals"),
        ("threads", "allowed are .*number_of_threads"),
        ("qqq", "allowed are input_data, method, use_normals, .*plane_pair_distance"),
    ],
)
def test_unknown_attributes_are_refused(name: str, says: str) -> None:
    found = MirrorDetection()
    with pytest.raises(AttributeError, match=says):
        setattr(found, name, 1)
    with pytest.raises(AttributeError, match=says):
        getattr(found, name)
    with pytest.raises(TypeError, match=f"{name!r}; {says.split('; ')[-1]}"):
        MirrorDetection(**{name: 1})


def test_what_is_no_property_is_no_keyword() -> None:
    for name in ("Update", "MIRROR", "GetOutput", "output"):
        with pytest.raises((TypeError, AttributeError), match=name):
            MirrorDetection(**{name: 1})


def test_parameters_reach_the_method() -> None:
    found = detection(mirrored_shape())
    before = found.GetMTime()
    found.SetPlanePairDistance(found.GetPlanePairDistance())
    assert found.GetMTime() == before
    found.SetPlanePairDistance(0)
    assert found.GetMTime() > before
    found.Update()
    assert np.nanmax(array(found.output, "MirrorResidual"), initial=0) < 1e-12


def test_bad_input_is_an_error_and_a_later_good_run_works() -> None:
    nan = mirrored_shape(10)
    nan[3, 1] = np.nan
    line = np.arange(9.0)[:, None] * [1, 2, 3]
    found = detection(mirrored_shape())
    good = found.GetInputDataObject(0, 0)
    for points, said in [
        (nan[:4], "3 of 4 points given are finite"),
        (line, "line"),
        (line[:1], "1 points"),
    ]:
        found.SetInputData(polydata(points))
        assert said in error_of(found)
        assert found.GetOutput(found.MIRROR).GetNumberOfPoints() == 0
        found.SetInputData(good)
        assert error_of(found) == ""
        assert found.GetOutput(found.MIRROR).GetNumberOfPoints() > 0
    found.SetInputData(vtkPolyData())
    assert "0 points" in error_of(found)
    assert "0 connections" in error_of(MirrorDetection())
    found.SetInputDataObject(vtkTable())
    assert "the input is a vtkTable; allowed are vtkPolyData and" in error_of(found)


@pytest.mark.parametrize("cloud", tables.clouds(), ids=lambda cloud: cloud.name)
def test_clouds_of_the_table(cloud: tables.Cloud) -> None:
    found = MirrorDetection(refuse_nonfinite=cloud.refuses_nonfinite)
    good = polydata(mirrored_shape(50))
    for method in symsurf.methods():
        found.method = method
        found.input_data = polydata(np.array(cloud.points, float).reshape(-1, 3))
        assert cloud.reason in error_of(found)
        assert [found.GetOutput(port).GetNumberOfPoints() for port in range(3)] == [0, 0, 0]
    found.method, found.input_data = "plane", good
    assert error_of(found) == "" and found.output.GetNumberOfPoints() > 0


@pytest.mark.parametrize("method", symsurf.methods())
def test_numbers_out_of_range(method: str) -> None:
    found = detection(mirrored_shape(50), method)
    for parameter, value in tables.numbers_out_of_range(symsurf.methods()[method].parameters):
        name = f"{method}_{parameter.name}"
        setattr(found, name, value)
        assert f"{parameter.name} is " in error_of(found)
        assert found.output.GetNumberOfPoints() == 0
        setattr(found, name, parameter.default)
    assert error_of(found) == ""


@pytest.mark.parametrize("ids", [(0, 1, 100), (0, 1, 2, 100), (-1, 1, 2), (0, 1, 2, -7)])
@pytest.mark.parametrize("strips", [False, True])
def test_polygons_that_name_no_point(ids: tuple[int, ...], strips: bool) -> None:
    shape = polydata(mirrored_shape(50))
    cells = vtkCellArray()
    cells.InsertNextCell(len(ids), ids)
    shape.SetStrips(cells) if strips else shape.SetPolys(cells)
    found = MirrorDetection(method="plane", input_data=shape)
    assert "a cell names point" in error_of(found)
    found.use_faces = False  # the outputs would have the cells all the same
    assert "a cell names point" in error_of(found)


def test_points_that_are_not_finite_are_left_out() -> None:
    points = mirrored_shape()
    plain = symsurf.detect(points, "plane")
    given = np.vstack([np.full((2, 3), np.nan), points, [(np.inf, 0, 0)]])
    found = detection(given)
    said = error_of(found, "WarningEvent")
    assert "3 points are not finite" in said
    shape = found.output
    partners = array(shape, "MirrorPartner")
    assert (partners[[0, 1, -1]] == -1).all() and (
        array(shape, "MirrorSide")[[0, 1, -1]] == 0
    ).all()
    np.testing.assert_array_equal(partners[plain.pairs[:, 0] + 2], plain.pairs[:, 1] + 2)
    fields = found.GetOutput(found.MIRROR).GetFieldData()
    assert fields.GetArray("NonfinitePoints").GetValue(0) == 3
    assert fields.GetAbstractArray("Verdict").GetValue(0) == plain.verdict
    assert fields.GetAbstractArray("Reason").GetValue(0) == plain.reason
    found.SetRefuseNonfinite(True)
    assert "point 0 is (nan, nan, nan)" in error_of(found)
    assert found.GetOutput(found.MIRROR).GetNumberOfPoints() == 0


def test_polygons_are_a_surface() -> None:
    cube = vtkCubeSource()
    cube.SetXLength(2)
    cube.SetYLength(3)
    cube.Update()
    box = cube.GetOutput()
    points = vtk_to_numpy(box.GetPoints().GetData())
    faces = [face for q in range(0, 24, 4) for face in ((q, q + 1, q + 3), (q, q + 3, q + 2))]
    expected = symsurf.detect(points, "plane", faces=faces)
    found = MirrorDetection()
    found.SetInputData(box)
    found.SetMethod("plane")
    found.Update()
    fields = found.GetOutput(found.MIRROR).GetFieldData()
    samples = fields.GetArray("SurfaceSamples").GetValue(0)
    assert samples == expected.statistics["surface_samples"] > 10000
    assert fields.GetArray("Score").GetValue(0) == pytest.approx(expected.score, abs=1e-3)
    found.SetUseFaces(False)
    found.Update()
    assert found.GetOutput(found.MIRROR).GetFieldData().GetArray("SurfaceSamples") is None


def test_candidates_are_shown_when_asked_for() -> None:
    cube = vtkCubeSource()
    cube.SetYLength(2)
    cube.SetZLength(3)
    cube.Update()
    found = MirrorDetection()
    found.SetInputData(cube.GetOutput())
    found.SetMethod("plane")
    found.Update()
    alone = found.GetOutput(found.MIRROR).GetNumberOfCells()
    assert not vtk_to_numpy(found.GetOutput(found.MIRROR).GetCellData().GetArray("Rank")).any()
    found.SetShowCandidates(True)
    found.Update()
    mirror = found.GetOutput(found.MIRROR)
    ranks = vtk_to_numpy(mirror.GetCellData().GetArray("Rank"))
    assert (ranks[:alone] == 0).all() and set(ranks) == {0, 1, 2}
    assert np.allclose(vtk_to_numpy(mirror.GetCellData().GetArray("Score")), 1)

    fields = {
        name: vtk_to_numpy(mirror.GetFieldData().GetArray(name))
        for name in ("Normal", "CandidateNormals", "CandidateOffsets", "CandidateScores")
    }
    normals = np.vstack([fields["Normal"], fields["CandidateNormals"]])
    axes = np.abs(normals).argmax(axis=1)
    assert np.allclose(np.abs(normals), np.eye(3)[axes]) and set(axes) == {0, 1, 2}
    assert np.allclose(fields["CandidateOffsets"], 0, atol=1e-9)
    assert np.allclose(fields["CandidateScores"], 1) and len(fields["CandidateScores"]) == 2
    points = vtk_to_numpy(mirror.GetPoints().GetData())
    corners = vtk_to_numpy(mirror.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    for rank, normal in enumerate(normals):
        assert np.allclose(points[corners[ranks == rank].ravel()] @ normal, 0, atol=1e-9)


def test_candidates_of_other_kinds_have_scores() -> None:
    points = mirrored_shape(100)
    expected = symsurf.detect(points, "sphere").candidates
    found = detection(points, "sphere")
    found.SetShowCandidates(True)
    found.Update()
    fields = found.GetOutput(found.MIRROR).GetFieldData()
    scores = vtk_to_numpy(fields.GetArray("CandidateScores"))
    assert np.array_equal(scores, [candidate.score for candidate in expected]) and len(expected) > 0
    assert fields.GetArray("CandidateNormals") is None
    ranks = vtk_to_numpy(found.GetOutput(found.MIRROR).GetCellData().GetArray("Rank"))
    assert set(ranks) == set(range(1 + len(expected)))


def test_bad_parameters_are_errors() -> None:
    found = detection(mirrored_shape(), "no such")
    assert "'no such'" in error_of(found)
    found.SetMethod("plane")
    found.SetPlanePairDistance(-1)
    assert "pair_distance is -1" in error_of(found)


def test_normals_that_are_asked_for_must_be_there() -> None:
    found = detection(mirrored_shape())
    found.SetUseNormals(True)
    assert "the input has no point normals" in error_of(found)
    assert found.GetOutput(found.MIRROR).GetNumberOfPoints() == 0
    found.SetUseNormals(False)
    assert error_of(found) == ""


def test_abort_empties_the_outputs() -> None:
    found = detection(mirrored_shape(20000))
    found.AddObserver("ProgressEvent", lambda caller, _event: caller.SetAbortExecute(1))
    found.Update()
    assert [found.GetOutput(port).GetNumberOfPoints() for port in range(3)] == [0, 0, 0]


def test_pipeline_operator() -> None:
    sphere = vtkSphereSource()
    if not hasattr(sphere, "__rshift__"):
        pytest.skip("this VTK has no >> pipelines")
    shape, mirror, surface = (sphere >> detection(np.empty((0, 3))))()
    assert mirror.GetNumberOfPolys() > 0
    assert shape.GetNumberOfPoints() == sphere.GetOutput().GetNumberOfPoints()
    assert surface.GetNumberOfPoints() > 0
