"""Arrays of NumPy and data sets of VTK, made of one another."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    VTK_BIT,
    vtkIdList,
    vtkStringArray,
)
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkDataObject,
    vtkDataSetAttributes,
    vtkFieldData,
    vtkPointData,
    vtkPolyData,
)

from .._core import InvalidInput, Mirror, make_mirror
from ..results import OperationResult
from ..shapes.kinds import Carry
from ..shapes.poly_data import kinds_of, vtk_points
from .names import camel_case


def vtk_cells(rows: NDArray[np.int64]) -> vtkCellArray:
    """A cell each row."""
    cells = vtkCellArray()
    cells.SetData(rows.shape[1], numpyTovtkDataArray(np.ascontiguousarray(rows).ravel()))
    return cells


def set_vertices(output: vtkPolyData, points: NDArray[np.float64]) -> None:
    """Points, and one vertex each."""
    output.SetPoints(vtk_points(points))
    output.SetVerts(vtk_cells(np.arange(len(points), dtype=np.int64)[:, None]))


def add_values(field: vtkFieldData, values: dict[str, Any]) -> None:
    """An array a value, named as VTK names things."""
    for name, value in values.items():
        if isinstance(value, str):
            array: Any = vtkStringArray()
            array.InsertNextValue(value)
        else:
            rows = np.atleast_2d(np.asarray(value, np.int64 if isinstance(value, bool) else None))
            array = numpyTovtkDataArray(np.ascontiguousarray(rows))
        array.SetName(camel_case(name))
        field.AddArray(array)


def is_mirror(data: vtkDataObject) -> bool:
    """Whether the field data have Kind. The shape of a detection has it too, but beside
    MirrorResidualP99."""
    return _has_kind(data) and not data.GetFieldData().HasArray("MirrorResidualP99")


def _has_kind(data: vtkDataObject) -> bool:
    field = data.GetFieldData()
    return isinstance(field and field.GetAbstractArray("Kind"), vtkStringArray)


def mirror_of(data: vtkPolyData) -> Mirror:
    """The mirror that the field data of a detection's output "Mirror" describes. Raises InvalidInput
    where it describes none."""
    if not is_mirror(data):
        given = "is the shape of a mirror detection"
        raise InvalidInput(
            f"the mirror {given if _has_kind(data) else 'has no field data array Kind'}; connect "
            'output 1 "Mirror" of a mirror detection'
        )
    field = data.GetFieldData()
    values = {}
    for i in range(field.GetNumberOfArrays()):
        array = field.GetAbstractArray(i)
        if array.GetName() and array.GetNumberOfValues() > 0:
            values[_core_name(array.GetName())] = _value(array)
    return make_mirror(str(values.pop("kind")), values)


def _core_name(name: str) -> str:
    spaced = "".join("_" + letter if letter.isupper() else letter for letter in name)
    return spaced.removeprefix("_").lower()


def _value(array: Any) -> Any:
    if array.IsA("vtkStringArray"):
        return str(array.GetValue(0))
    rows = vtk_to_numpy(array)
    if array.GetNumberOfValues() == 1:
        return rows.ravel()[0].item()
    return rows[0] if rows.shape == (1, 3) else rows.reshape(len(rows), -1)


def set_subset(
    output: vtkPolyData, data: vtkPolyData, points: NDArray[np.float64], kept: NDArray[np.int64]
) -> None:
    """Makes the output the rows ``kept`` (rising) of the data set, moved to ``points``, with their
    data and with the cells that need no other rows. All rows: the cells as they are."""
    if len(kept) == data.GetNumberOfPoints():
        output.ShallowCopy(data)
    else:
        output.GetFieldData().ShallowCopy(data.GetFieldData())
        copy_rows(output.GetPointData(), data.GetPointData(), kept)
        _copy_whole_cells(output, data, kept)
    output.SetPoints(vtk_points(points))


def drop_normals(data: vtkPolyData) -> None:
    data.GetPointData().SetNormals(None)
    data.GetCellData().SetNormals(None)


def copy_rows(
    to: vtkDataSetAttributes, source: vtkDataSetAttributes, rows: NDArray[np.int64]
) -> None:
    """Makes the data that of the rows of another."""
    to.Initialize()
    to.CopyAllOn()
    to.CopyAllocate(source, len(rows))
    to.CopyData(source, _ids(rows), _ids(np.arange(len(rows))))


def carry_rows(
    to: vtkDataSetAttributes,
    source: vtkDataSetAttributes,
    made: OperationResult,
    kinds: Mapping[str, str] | None = None,
) -> None:
    """Makes the data those of the points of a result: active vectors, normals and tensors, and arrays of
    further ``kinds``, are turned with their points; of others real numbers and colours are interpolated where points lie between several."""
    copy_rows(to, source, made.sources)
    _set_carried(to, source, made.carried, kinds or {})


def turn_rows(data: vtkDataSetAttributes, carried: Carry) -> None:
    """Turns active vectors, normals and tensors, in arrays of their own."""
    before = vtkPointData()
    before.ShallowCopy(data)
    copy_rows(data, before, np.arange(before.GetNumberOfTuples()))
    _set_carried(data, before, carried, {})


def _set_carried(
    to: vtkDataSetAttributes,
    source: vtkDataSetAttributes,
    carried: Carry,
    further: Mapping[str, str],
) -> None:
    kinds = kinds_of(source) | dict(further)
    for i in range(source.GetNumberOfArrays()):
        if (array := source.GetArray(i)) is not None and array.GetDataType() != VTK_BIT:
            name = array.GetName()
            values = vtk_to_numpy(array)
            vtk_to_numpy(to.GetArray(i))[:] = carried(values, kinds.get(name, "scalar"), name)


def _ids(rows: NDArray[np.int64]) -> vtkIdList:
    ids = vtkIdList()
    ids.SetNumberOfIds(len(rows))
    for place, row in enumerate(rows.tolist()):
        ids.SetId(place, row)
    return ids


def _copy_whole_cells(output: vtkPolyData, data: vtkPolyData, kept: NDArray[np.int64]) -> None:
    renumbered = np.full(data.GetNumberOfPoints(), -1)
    renumbered[kept] = np.arange(len(kept))
    sources, first = [], 0
    for kind in ("Verts", "Lines", "Polys", "Strips"):
        cells = getattr(data, f"Get{kind}")()
        whole, copy = _whole_cells(cells, renumbered)
        getattr(output, f"Set{kind}")(copy)
        sources.append(first + np.flatnonzero(whole))
        first += len(whole)
    copy_rows(output.GetCellData(), data.GetCellData(), np.concatenate(sources))


def _whole_cells(
    cells: vtkCellArray, renumbered: NDArray[np.int64]
) -> tuple[NDArray[np.bool_], vtkCellArray]:
    """Which cells have all their points still, and these."""
    corners = renumbered[vtk_to_numpy(cells.GetConnectivityArray())]
    sizes = np.diff(vtk_to_numpy(cells.GetOffsetsArray()))
    cell_of = np.repeat(np.arange(len(sizes)), sizes)
    whole = np.bincount(cell_of[corners < 0], minlength=len(sizes)) == 0
    copy = vtkCellArray()
    offsets = np.concatenate([[0], np.cumsum(sizes[whole])]).astype(np.int64)
    copy.SetData(numpyTovtkDataArray(offsets), numpyTovtkDataArray(corners[whole[cell_of]]))
    return whole, copy
