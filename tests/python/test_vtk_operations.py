"""The filters of the operations in the vtk package that pip installs."""

from __future__ import annotations

import numpy as np
import pytest

import symsurf

pyvista = pytest.importorskip("pyvista", reason="needs the vtk package")

from bad_input import tables
from symmetric_shapes import lopsided_blob, mirrored_surface
from vtk_data import (
    BALL_MIRROR,
    array,
    dented_ball,
    error_of,
    halved,
    mirror_data,
    polydata,
)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

import symsurf.vtk
from symsurf import _core
from symsurf.vtk import MirrorDetection, MirrorOperation

OPERATIONS = list(symsurf.operations().values())


def filter_of(operation: symsurf.Operation, **properties: object) -> MirrorOperation:
    words = operation.title.split()
    return getattr(symsurf.vtk, "".join(word.capitalize() for word in words))(**properties)


def on_ball(operation: symsurf.Operation, **properties: object) -> MirrorOperation:
    return filter_of(
        operation, input_data=dented_ball(), mirror_data=mirror_data(BALL_MIRROR), **properties
    )


def points_of(data: vtkPolyData) -> np.ndarray:
    return vtk_to_numpy(data.GetPoints().GetData())


def triangles_of(data: vtkPolyData) -> np.ndarray:
    """As VTK divides them: compared with what the filter does, not with one's own idea."""
    from symsurf.shapes.poly_data import faces_of

    return faces_of(data).corners


@pytest.fixture(params=OPERATIONS, ids=lambda operation: operation.name)
def operation(request: pytest.FixtureRequest) -> symsurf.Operation:
    return request.param


def test_gives_what_the_core_gives(operation: symsurf.Operation) -> None:
    ball = dented_ball()
    found = on_ball(operation)
    assert error_of(found) == ""
    expected = _core.operate(
        operation.name, points_of(ball), triangles_of(ball), BALL_MIRROR, None, 0, None, {}
    )
    output = found.output
    assert np.array_equal(points_of(output), expected["points"])
    name = type(found).__name__
    for described in operation.arrays:
        if described.name not in expected["arrays"]:
            continue
        made = array(output, name + "".join(map(str.capitalize, described.name.split("_"))))
        if described.name != "face":
            np.testing.assert_array_equal(made, expected["arrays"][described.name])
    if operation.shown:
        assert output.GetPointData().GetScalars().GetName() == name + operation.shown.capitalize()
    fields = output.GetFieldData()
    names = {fields.GetArrayName(i) for i in range(fields.GetNumberOfArrays())}
    assert names == {
        "".join(map(str.capitalize, statistic.split("_"))) for statistic in expected["statistics"]
    }


def test_keeps_cells_and_data_of_the_input(operation: symsurf.Operation) -> None:
    ball = dented_ball()
    found = on_ball(operation)
    found.Update()
    output = found.output
    if operation.name in ("remesh", "cut"):
        pytest.skip("makes other points and cells")
    count, cells = ball.GetNumberOfPoints(), ball.GetNumberOfCells()
    if not operation.carries_values:
        assert np.array_equal(array(output, "Id")[:count], np.arange(count))
    ids = vtk_to_numpy(output.GetCellData().GetArray("CellId"))
    assert np.array_equal(ids[:cells], np.arange(cells))
    ends = vtk_to_numpy(ball.GetPolys().GetConnectivityArray())
    now = vtk_to_numpy(output.GetPolys().GetConnectivityArray())
    assert np.array_equal(now[: len(ends)], ends)
    # The average of two sides has no Jacobian.
    has_normals = output.GetPointData().GetNormals() is not None
    assert has_normals == (operation.name != "symmetrize")


def test_finds_the_mirror_where_none_is_connected(operation: symsurf.Operation) -> None:
    detection = MirrorDetection(method="plane", input_data=dented_ball())
    connected = filter_of(operation, input_data=dented_ball())
    connected.SetMirrorConnection(detection.GetOutputPort(detection.MIRROR))
    alone = filter_of(operation, input_data=dented_ball(), method="plane")
    connected.Update()
    alone.Update()
    # A mirror that comes by field data is that of the detection but for the length of its normal.
    np.testing.assert_allclose(points_of(connected.output), points_of(alone.output), atol=1e-12)
    assert error_of(connected) == error_of(alone) == ""
    connected.SetMirrorConnection(None)
    connected.SetMethod("plane")
    assert error_of(connected) == "" and connected.output.GetNumberOfPoints() > 0


def test_asymmetry_after_a_detection_is_that_of_the_shape() -> None:
    detection = MirrorDetection(method="plane", input_data=dented_ball(60, 40))
    asymmetry = filter_of(symsurf.operations()["asymmetry"], method="plane")
    asymmetry.SetInputConnection(detection.GetOutputPort())
    assert error_of(asymmetry) == ""
    found = asymmetry.output.GetFieldData().GetArray("Maximum").GetValue(0)
    assert found == pytest.approx(0.1, abs=0.015)  # the depth of the dent, which tilts the plane
    asymmetry.mirror_data = mirror_data(BALL_MIRROR)
    asymmetry.Update()
    known = asymmetry.output.GetFieldData().GetArray("Maximum").GetValue(0)
    assert found == pytest.approx(known, abs=0.01)


def test_a_mirror_that_is_none_warns_unless_refused(operation: symsurf.Operation) -> None:
    points = lopsided_blob(600)
    found = filter_of(operation, method="plane", input_data=polydata(points))
    reason = symsurf.detect(points, "plane").reason
    if operation.needs_faces:
        assert f"{operation.name} needs a mesh" in error_of(found)
        return
    assert reason in error_of(found, "WarningEvent")
    assert found.output.GetNumberOfPoints() >= len(points) * (0.3 if operation.makes_shape else 1)
    found.require_found = True
    assert f"the shape has no mirror: {reason}" in error_of(found)
    assert found.output.GetNumberOfPoints() == 0
    symmetric, _ = mirrored_surface(400, 1)
    thesis = filter_of(operation, method="separation", input_data=polydata(symmetric))
    assert "the result of separation has no mirror" not in error_of(thesis)
    found.method = "horoscope"
    assert "'horoscope'" in error_of(found)


def test_completion_adds_what_the_other_side_has() -> None:
    whole = dented_ball(48, 31)
    half = halved(whole, lambda x: x[:, 0] < 0.2)
    completion = symsurf.vtk.MirrorCompletion(input_data=half, mirror_data=mirror_data(BALL_MIRROR))
    assert error_of(completion) == ""
    made = completion.output
    points, cells = half.GetNumberOfPoints(), half.GetNumberOfCells()
    origin = array(made, "MirrorCompletionOrigin")
    assert (origin[:points] == 0).all() and (origin[points:] > 0).all()
    assert np.array_equal(points_of(made)[:points], points_of(half))
    assert made.GetNumberOfCells() > 1.3 * cells

    # What is added lies on the other side, and has its data of the points and cells it is made from.
    sources = array(made, "Id")[points:]
    images = BALL_MIRROR.reflect(points_of(half)[sources])
    apart = np.linalg.norm(images - points_of(made)[points:], axis=1)
    assert np.median(apart) < 1e-12 and apart.max() < 0.1
    cell_ids = vtk_to_numpy(made.GetCellData().GetArray("CellId"))
    assert np.array_equal(cell_ids[:cells], np.arange(cells)) and cell_ids[cells:].max() < cells

    patch = completion.GetOutput(completion.PATCH)
    assert patch.GetNumberOfCells() == made.GetNumberOfCells() - cells
    kept = array(patch, "MirrorCompletionOrigin")
    assert np.array_equal(points_of(patch)[kept > 0], points_of(made)[points:])
    assert {0, 1} <= set(kept)  # the rim of the half is where the patch begins
    used = np.unique(vtk_to_numpy(patch.GetPolys().GetConnectivityArray()))
    assert np.array_equal(used, np.arange(patch.GetNumberOfPoints()))


def test_completion_of_a_cloud_adds_vertices() -> None:
    whole = points_of(dented_ball(48, 31))
    cloud = polydata(whole[whole[:, 0] < 0.2])
    completion = symsurf.vtk.MirrorCompletion(
        input_data=cloud, mirror_data=mirror_data(BALL_MIRROR)
    )
    completion.Update()
    assert completion.output.GetNumberOfPoints() > cloud.GetNumberOfPoints()
    assert completion.output.GetNumberOfCells() == 0

    verts = vtkCellArray()
    for i in range(cloud.GetNumberOfPoints()):
        verts.InsertNextCell(1, (i,))
    cloud.SetVerts(verts)
    completion.input_data = cloud
    cloud.Modified()
    completion.Update()
    made, patch = completion.output, completion.GetOutput(1)
    assert made.GetNumberOfVerts() == made.GetNumberOfPoints()
    assert patch.GetNumberOfVerts() == patch.GetNumberOfPoints() > 0
    assert patch.GetNumberOfPoints() == made.GetNumberOfPoints() - cloud.GetNumberOfPoints()


def test_points_that_the_mask_holds_stay() -> None:
    held = symsurf.vtk.MirrorSymmetrization(
        input_data=dented_ball(),
        mirror_data=mirror_data(BALL_MIRROR),
        side="negative",
        mask_array="Mask",
    )
    held.Update()
    before = dented_ball()
    distance = np.linalg.norm(points_of(held.output) - points_of(before), axis=1)
    assert (distance[array(before, "Mask") == 0] == 0).all() and distance.max() > 0.01
    for name, says in [
        ("Masc", "MaskArray is 'Masc'; allowed are the input's point arrays: Id, Mask, Normals"),
        ("Normals", "MaskArray is 'Normals', which has 3 components; allowed is one"),
        ("Id", "mask value 2 is 2"),
    ]:
        held.mask_array = name
        assert says in error_of(held) and held.output.GetNumberOfPoints() == 0
    held.mask_array = "None"
    assert error_of(held) == ""


def test_faces_of_correspondences_are_cells_of_the_input() -> None:
    ball = dented_ball()
    found = symsurf.vtk.MirrorCorrespondences(input_data=ball, mirror_data=mirror_data(BALL_MIRROR))
    found.Update()
    faces = array(found.output, "MirrorCorrespondencesFace")
    partners = array(found.output, "MirrorCorrespondencesIndex")
    for partner, face in zip(partners[partners >= 0], faces[partners >= 0]):
        ids = ball.GetCell(face).GetPointIds()
        assert partner in {ids.GetId(k) for k in range(ids.GetNumberOfIds())}
    assert np.array_equal(faces < 0, partners < 0)


@pytest.mark.parametrize("deviation", [None, 0.01])
def test_landmarks_count_as_pairs_do(deviation: float | None) -> None:
    body = pyvista.Icosphere(nsub=3).rotate_vector((1, 2, 3), 40)  # no vertex has a twin
    body.points = np.asarray(body.points, dtype=float) * (1, 0.8, 1.2)
    pairs = np.array([(3, 50), (120, 7)])
    landmarks = polydata(body.points[pairs.ravel()])
    if deviation is not None:
        values = numpy_to_vtk(np.full(4, deviation), deep=True)
        values.SetName("Deviation")
        landmarks.GetPointData().AddArray(values)
    filter_ = symsurf.vtk.MirrorAsymmetry(
        input_data=body,
        mirror_data=mirror_data(symsurf.Plane((1, 0, 0), 0)),
        landmarks_data=landmarks,
        pairing="homologous",
    )
    filter_.Update()
    found = array(filter_.output, "MirrorAsymmetryVector")
    expected, without = (
        symsurf.asymmetry(body, "x=0", pairing="homologous", **given).vector
        for given in ({"pairs": pairs, "pairs_sd": deviation or 0}, {})
    )
    assert np.nanmax(abs(expected - without)) > 1e-2
    np.testing.assert_allclose(found, expected, atol=1e-9)
    filter_.landmarks_data = polydata(body.points[:3])
    assert "3 points; allowed are two for each pair" in error_of(filter_)


def test_properties_are_the_descriptions(operation: symsurf.Operation) -> None:
    found = filter_of(operation)
    assert operation.summary in " ".join(type(found).__doc__.split())
    for parameter in operation.parameters:
        name = "".join(map(str.capitalize, parameter.name.split("_")))
        assert np.array_equal(getattr(found, parameter.name), parameter.default)
        assert np.array_equal(getattr(found, f"Get{name}")(), parameter.default)
        assert parameter.doc in getattr(type(found), parameter.name).__doc__
        before = found.GetMTime()
        getattr(found, f"Set{name}")(parameter.default)
        assert found.GetMTime() == before
    with pytest.raises(AttributeError, match="nearest: method"):
        found.metod = "plane"
    with pytest.raises(TypeError, match="'mirror'; nearest: mirror_data"):
        filter_of(operation, mirror=None)


def test_numbers_out_of_range(operation: symsurf.Operation) -> None:
    found = on_ball(operation)
    for parameter, value in tables.numbers_out_of_range(operation.parameters):
        setattr(found, parameter.name, value)
        assert f"{parameter.name} is " in error_of(found)
        assert found.output.GetNumberOfPoints() == 0
        setattr(found, parameter.name, parameter.default)
    assert error_of(found) == ""


def test_clouds_of_the_table(operation: symsurf.Operation) -> None:
    found = filter_of(operation, method="plane")
    for cloud in tables.clouds():
        points = np.array(cloud.points, float).reshape(-1, 3)
        found.input_data = polydata(points)
        said = error_of(found)
        if cloud.refuses_nonfinite:  # some are left out: no option of operations refuses them
            assert "finite" not in said, cloud.name
            continue
        assert cloud.reason in said, cloud.name
        assert found.output.GetNumberOfPoints() == 0
    found.input_data = dented_ball()
    assert error_of(found) == ""


def test_mirrors_of_the_table(operation: symsurf.Operation) -> None:
    from symsurf.vtk.arrays import add_values

    found = on_ball(operation)
    for row in tables.mirrors():
        data = vtkPolyData()
        add_values(data.GetFieldData(), {"kind": row.kind} | row.numbers)
        found.mirror_data = data
        assert row.reason in error_of(found), row.name
        assert found.output.GetNumberOfPoints() == 0
    found.mirror_data = vtkPolyData()
    assert "the mirror has no field data array Kind" in error_of(found)
    found.mirror_data = mirror_data(BALL_MIRROR)
    assert error_of(found) == ""


def test_abort_empties_the_outputs(operation: symsurf.Operation) -> None:
    found = on_ball(operation)
    found.AddObserver("ProgressEvent", lambda caller, _event: caller.SetAbortExecute(1))
    found.Update()
    ports = range(found.GetNumberOfOutputPorts())
    assert [found.GetOutput(port).GetNumberOfPoints() for port in ports] == [0] * len(ports)
