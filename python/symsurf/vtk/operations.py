"""A filter for each of ``operations()``, made from its description: MirrorAsymmetry, ..."""

from __future__ import annotations

import textwrap
import warnings
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithmOutput

from .. import _core
from .._core import (
    InvalidInput,
    InvalidParameter,
    Mirror,
    Operation,
    methods,
    operations,
    require_found_parameter,
)
from ..base.input_warning import InputWarning
from ..detection import detect
from ..reading.inputs import require_finite
from ..results import found_mirror
from ..results.operation_results import RESULTS
from ..shapes import Shape
from ..shapes.poly_data import Faces, faces_of, points_of, vtk_points
from .algorithm import REFUSE_NONFINITE, SEED, THREADS, Algorithm, Property, described
from .arrays import (
    add_values,
    carry_rows,
    copy_rows,
    mirror_of,
    set_subset,
    vtk_cells,
)
from .names import camel_case

_KINDS = ("vector", "normal", "tensor", "quaternion", "harmonics", "scalar")
_FOUND_AT = 0.6  # the share of the progress that finding the mirror takes


class MirrorOperation(Algorithm):
    """What the filters of the operations have in common; ``vtkMirrorOperation`` in Python.

    Input 0 is the shape. Input 1, optional, is its mirror: output 1 of ``MirrorDetection``, in the
    unit and pose of the shape. Without it the mirror is found first, by ``method``; where its verdict
    is "none", it is used with a warning that says why, unless ``require_found`` is set.

    Input 2, optional, is the second of two shapes of a pair, in a pose of its own, in place of a mirror:
    for the operations that take one, see ``operations()``.

    Input 3, optional, with homologous pairing, has landmarks: points of which each two that follow each
    other mirror each other. Their point array "Deviation", or else 0, is the standard deviation of placing
    the two, input units.

    Output 0 has the points and cells of the input in their order, moved where the operation moves
    them, with their data, and behind them what the operation adds, with the data of what it is made
    from. Active vectors, normals and tensors of points, and those that ``kinds`` names, go along;
    normals of points that are moved each by itself (symmetrization) and of cells are not passed on.
    Figures about the whole are field data.
    """

    operation: ClassVar[Operation]

    _optional_inputs = (1, 2, 3)
    _inputs: ClassVar = {
        "input_data": "The shape, where no filter makes it.",
        "mirror_data": 'The output "Mirror" of a detection, where no filter makes it.',
        "other_data": "The second of two shapes, where no filter makes it.",
        "landmarks_data": "The landmarks, where no filter makes them.",
    }

    def SetMirrorConnection(self, mirror: vtkAlgorithmOutput | None) -> None:
        """Connects the mirror, input 1; None: it is found first."""
        self.SetInputConnection(1, mirror)

    def _run(self, inputs: list[Any], outputs: list[vtkPolyData]) -> None:
        shape, given, other, landmarks = inputs
        if given is not None and other is not None:
            raise InvalidParameter("a mirror and a second shape are given; allowed is one of them")
        options, operation = self._options, self.operation
        points, faces = points_of(shape), faces_of(shape)
        if options["refuse_nonfinite"]:
            require_finite(points)
        mask = _mask_of(shape, options["mask_array"]) if operation.takes_mask else None
        parameters = {each.name: options[each.name] for each in operation.parameters}
        kinds = _kinds_of(shape, options["kinds"])
        mirror: Mirror | None = None
        before: float = 0
        if other is None and _core.needs_mirror(operation.name, parameters):
            mirror = self._found_mirror(points, faces) if given is None else mirror_of(given)
            before = _FOUND_AT if given is None else 0
        result = _core.operate(
            operation.name,
            points,
            faces.corners,
            mirror,
            mask,
            options["number_of_threads"],
            lambda fraction: self._progress(before + (1 - before) * fraction),
            parameters,
            None if landmarks is None else _landmark_pairs(landmarks),
            other=None if other is None else points_of(other),
            other_faces=None if other is None else faces_of(other).corners,
        )
        self._warn_of(result["statistics"])
        added = _set_operated(outputs[0], shape, faces, operation, mirror, result, kinds)
        if operation.adds_points:
            _set_patch(outputs[1], added, len(points))

    def _found_mirror(self, points: NDArray[Any], faces: Faces) -> Mirror:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)  # said of the operation
            result = detect(
                points,
                self._options["method"],
                seed=self._options["seed"],
                faces=faces.corners,
                threads=self._options["number_of_threads"],
                progress=lambda fraction: self._progress(_FOUND_AT * fraction),
            )
        if "warning" in result.statistics:
            self._warn(result.statistics["warning"])
        mirror, warning = found_mirror(result, self._options["require_found"])
        if warning:
            self._warn(warning)
        return mirror


def _kinds_of(shape: vtkPolyData, text: str) -> dict[str, str]:
    kinds = {}
    for part in filter(None, text.split(",")):
        name, equals, kind = part.rpartition("=")
        if not equals or kind not in _KINDS or shape.GetPointData().GetArray(name) is None:
            raise InvalidParameter(
                f"kinds has {part!r}; allowed is NAME=KIND with a point array of the input and "
                f"{', '.join(_KINDS[:-1])} or {_KINDS[-1]}"
            )
        kinds[name] = kind
    return kinds


def _mask_of(shape: vtkPolyData, name: str) -> NDArray[np.float64] | None:
    data = shape.GetPointData()
    array = data.GetArray(name)
    if name == "" or (name == "None" and array is None):
        return None
    if array is None:
        names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
        raise InvalidParameter(
            f"MaskArray is {name!r}; allowed are the input's point arrays: "
            f"{', '.join(filter(None, names)) or 'none'}"
        )
    if array.GetNumberOfComponents() != 1:
        raise InvalidParameter(
            f"MaskArray is {name!r}, which has {array.GetNumberOfComponents()} components; allowed "
            "is one"
        )
    return vtk_to_numpy(array).astype(np.float64)


def _landmark_pairs(landmarks: vtkPolyData) -> NDArray[np.float64]:
    points = points_of(landmarks)
    if len(points) % 2:
        raise InvalidInput(f"the landmarks are {len(points)} points; allowed are two for each pair")
    array = landmarks.GetPointData().GetArray("Deviation")
    deviations = np.zeros(len(points)) if array is None else vtk_to_numpy(array)
    return np.column_stack([np.reshape(points, (-1, 6)), deviations[::2]])


def filter_name(operation: Operation) -> str:
    """ "MirrorAsymmetry" of "Mirror asymmetry"."""
    return camel_case(operation.title.replace(" ", "_"))


def array_name(operation: Operation, array: str) -> str:
    """ "MirrorAsymmetryDistance": an input may have a "Distance" of its own."""
    return filter_name(operation) + camel_case(array)


def _set_operated(
    output: vtkPolyData,
    shape: vtkPolyData,
    faces: Faces,
    operation: Operation,
    mirror: Mirror | None,
    result: dict[str, Any],
    kinds: dict[str, str],
) -> vtkPolyData:
    """Makes the output the shape with what the operation gave. Gives what was added: the output's
    points with the added cells alone, and their data."""
    verts, vert_sources = _added_verts(shape, faces, result)
    polys, poly_sources = _added_polys(faces, result)
    output.ShallowCopy(shape)
    made = RESULTS[operation.name].from_fields(
        result
        | {"given": Shape(points_of(shape), faces.corners), "mirror": mirror}
        | {"found": None, "seconds": 0}
    )
    if operation.carries_values:
        data = shape.GetPointData()
        carry_rows(output.GetPointData(), data, made, kinds)
        output.GetPointData().SetNormals(data.GetNormals())
        output.GetPointData().SetTCoords(data.GetTCoords())
    elif _is_other(result):
        output.DeleteCells()
        for set_cells in (output.SetLines, output.SetStrips):
            set_cells(vtkCellArray())
        output.SetVerts(verts)
        output.SetPolys(polys)
        carry_rows(output.GetPointData(), shape.GetPointData(), made, kinds)
        rows = np.concatenate([vert_sources, poly_sources])
        copy_rows(output.GetCellData(), shape.GetCellData(), rows)
    elif len(result["point_sources"]):
        output.DeleteCells()
        output.SetVerts(_joined(shape.GetVerts(), verts))
        output.SetPolys(_joined(shape.GetPolys(), polys))
        carry_rows(output.GetPointData(), shape.GetPointData(), made, kinds)
        old = np.arange(shape.GetNumberOfCells())
        ends = [shape.GetNumberOfVerts(), len(old) - shape.GetNumberOfStrips()]
        first, middle, last = np.split(old, ends)
        rows = np.concatenate([first, vert_sources, middle, poly_sources, last])
        copy_rows(output.GetCellData(), shape.GetCellData(), rows)
    elif made.turns:
        carry_rows(output.GetPointData(), shape.GetPointData(), made, kinds)
    if operation.moves_points or operation.adds_points:
        output.SetPoints(vtk_points(result["points"]))
        if operation.takes_mask and not made.turns:  # each by itself: nobody knows the normals
            output.GetPointData().SetNormals(None)
        output.GetCellData().SetNormals(None)
    _add_arrays(output, faces, operation, result)
    add_values(output.GetFieldData(), result["statistics"])

    added = vtkPolyData()
    added.SetPoints(output.GetPoints())
    added.GetPointData().ShallowCopy(output.GetPointData())
    added.GetFieldData().ShallowCopy(output.GetFieldData())
    added.SetVerts(verts)
    added.SetPolys(polys)
    copy_rows(
        added.GetCellData(), shape.GetCellData(), np.concatenate([vert_sources, poly_sources])
    )
    added.GetCellData().SetNormals(None)
    return added


def _added_polys(faces: Faces, result: dict[str, Any]) -> tuple[vtkCellArray, NDArray[np.int64]]:
    """The triangles behind those of the shape, and the shape's cells that they have their data of."""
    old = 0 if faces.corners is None or _is_other(result) else len(faces.corners)
    corners = result["faces"][old:]
    return _cells(corners), faces.cells[result["face_sources"][old:]]


def _added_verts(
    shape: vtkPolyData, faces: Faces, result: dict[str, Any]
) -> tuple[vtkCellArray, NDArray[np.int64]]:
    """Of a cloud that has vertices, one each of the added points; else none."""
    old, cells = shape.GetNumberOfPoints(), shape.GetNumberOfVerts()
    if faces.corners is not None or cells == 0:
        return vtkCellArray(), np.empty(0, np.int64)
    vert_of = np.zeros(old, np.int64)
    verts = shape.GetVerts()
    sizes = np.diff(vtk_to_numpy(verts.GetOffsetsArray()))
    vert_of[vtk_to_numpy(verts.GetConnectivityArray())] = np.repeat(np.arange(cells), sizes)
    first = 0 if _is_other(result) else old
    added = np.arange(first, len(result["points"]))
    return _cells(added[:, None]), vert_of[result["point_sources"][first:]]


def _is_other(result: dict[str, Any]) -> bool:
    """Whether points and faces are other ones than those of the shape altogether."""
    is_carried = _core.operations()[result["operation"]].carries_values
    return len(result["point_parents"]) > 0 and not is_carried


def _cells(rows: NDArray[np.int64]) -> vtkCellArray:
    return vtk_cells(rows) if len(rows) else vtkCellArray()


def _joined(first: vtkCellArray, second: vtkCellArray) -> vtkCellArray:
    cells = vtkCellArray()
    cells.DeepCopy(first)
    cells.Append(second)
    return cells


def _add_arrays(
    output: vtkPolyData, faces: Faces, operation: Operation, result: dict[str, Any]
) -> None:
    data = output.GetPointData()
    for name, values in result["arrays"].items():
        if values.dtype == np.bool_:
            values = values.astype(np.int8)
        if name == "face":  # a triangle is a part of a cell
            values = np.where(values >= 0, faces.cells[values], -1)
        data.AddArray(numpyTovtkDataArray(values, array_name(operation, name)))
    for name, values in result["face_arrays"].items():
        if len(values):
            row = numpyTovtkDataArray(values.astype(np.int8), array_name(operation, name))
            output.GetCellData().AddArray(row)
    if operation.shown:
        data.SetActiveScalars(array_name(operation, operation.shown))


def _set_patch(patch: vtkPolyData, added: vtkPolyData, first_added: int) -> None:
    """What was added, with the points that it shares with the shape."""
    points = points_of(added)
    used = np.zeros(len(points), bool)
    used[first_added:] = True
    used[vtk_to_numpy(added.GetPolys().GetConnectivityArray())] = True
    kept = np.flatnonzero(used)
    set_subset(patch, added, points[kept], kept)


def _docstring(operation: Operation) -> str:
    lines = [textwrap.fill(operation.summary, 96), ""]
    lines.append("Inputs, and what is kept of them: see ``MirrorOperation``.")
    if operation.adds_points:
        lines.append("Output 0 is the whole, output 1 what was added alone.")
    if operation.arrays:
        lines += ["Point data:", ""]
    for array in operation.arrays:
        text = f"- {array_name(operation, array.name)}: {array.doc}"
        lines.append(textwrap.fill(text, 96, subsequent_indent="  "))
    if operation.face_arrays:
        lines += ["", "Cell data:", ""]
    for array in operation.face_arrays:
        text = f"- {array_name(operation, array.name)}: {array.doc}"
        lines.append(textwrap.fill(text, 96, subsequent_indent="  "))
    return "\n".join(lines)


def _filter(operation: Operation) -> type[MirrorOperation]:
    properties = described(operation.parameters)
    if operation.takes_mask:
        properties["mask_array"] = Property(
            "",
            "The name of a point array, a value in [0, 1] each: how far the point may move. Empty, "
            "or None: all points may.",
        )
    properties["method"] = Property(
        next(iter(methods())),
        "How the mirror is found where none is connected, with the parameters that are there "
        f"initially. One of: {', '.join(methods())}",
    )
    properties |= {"seed": SEED, "refuse_nonfinite": REFUSE_NONFINITE}
    properties |= described([require_found_parameter()])
    properties["kinds"] = Property(
        "",
        "What further point arrays are, as ``wind=vector,stress=tensor``: vector, normal, tensor, "
        "quaternion, harmonics, or scalar for one that stays as it is. The active ones are known.",
    )
    properties["number_of_threads"] = THREADS
    members: dict[str, Any] = {
        "__doc__": _docstring(operation),
        "__module__": __name__,
        "operation": operation,
        "_properties": properties,
    }
    if operation.adds_points:
        members |= {"_output_count": 2, "WHOLE": 0, "PATCH": 1}
    return type(filter_name(operation), (MirrorOperation,), members)


_FILTERS = {filter_name(operation): _filter(operation) for operation in operations().values()}
__all__ = [name for name in _FILTERS]
globals().update(_FILTERS)
