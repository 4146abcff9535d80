"""The detection as a VTK filter, for the ``vtk`` package that pip installs.

>>> from symsurf.vtk import MirrorDetection
>>> detection = MirrorDetection(method="plane")
>>> detection.SetInputConnection(reader.GetOutputPort())
>>> detection.Update()
>>> mirror = detection.GetOutput(MirrorDetection.MIRROR)

Programs built on VTK or ParaView have the same filter in C++: ``vtkMirrorDetection``.
"""

from __future__ import annotations

import warnings
from difflib import get_close_matches
from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkDataArray, vtkOutputWindow, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkFieldData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkTriangleFilter

from ._core import Cancelled, InvalidInput, InvalidParameter, Plane, methods
from .descriptions import allowed
from .detection import detect
from .inputs import InputWarning
from .result import Result

__all__ = ["MirrorDetection"]


class MirrorDetection(VTKPythonAlgorithmBase):
    """Finds the mirror of a ``vtkPolyData``; ``vtkMirrorDetection`` in Python.

    Where it has polygons, samples of their surface find the mirror, unless UseFaces is off. Points
    that are not finite are left out, with a warning, and have no partners; with RefuseNonfinite they
    are an error.

    Output 0 "Mirror": triangles over the footprint, of the candidates too with ShowCandidates; cell
    data Rank (0 the result, from 1 the candidates) and Score; field data, of the result, Method,
    Kind, Score, the mirror's numbers and the method's statistics, and CandidateScores, of planes
    also CandidateNormals and CandidateOffsets, where there are candidates. Output 1 "Surface Points": a vertex in the middle of each
    pair, at most half its residual off the mirror (``perpendicular``, ``quadric`` and
    ``fixed_direction`` project it onto that); point data Residual. Output 2 "Mapping": the input;
    point data MirrorPartner (index, -1 for none), MirrorResidual (NaN for none) and MirrorSide.

    Every parameter of every method is a property, a keyword of the constructor, and has its setter
    and getter: ``plane_pair_distance`` and ``SetPlanePairDistance`` for ``pair_distance`` of
    ``plane``. Other attributes cannot be set. Points are read in place when they are doubles. Bad
    input and values out of range are errors of the filter; they leave the outputs empty.
    """

    MIRROR, SURFACE_POINTS, MAPPING = range(3)

    def __init__(self, **properties: Any) -> None:
        super().__init__(
            nInputPorts=1, inputType="vtkPolyData", nOutputPorts=3, outputType="vtkPolyData"
        )
        self._options: dict[str, Any] = {
            name: default for name, (default, _) in _properties().items()
        }
        for name, value in properties.items():
            if not hasattr(getattr(type(self), name, None), "__set__"):
                raise TypeError(f"unexpected keyword argument {name!r}; {_nearest(name)}")
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        is_made = "_options" in vars(self)  # VTK's own base class sets some attributes
        if is_made and not hasattr(self, name):
            raise AttributeError(_no_attribute(self, name), name=name, obj=self)
        super().__setattr__(name, value)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(_no_attribute(self, name), name=name, obj=self)

    def SetInputData(self, data: vtkPolyData) -> None:
        """The shape, where no filter or reader makes it."""
        self.SetInputDataObject(0, data)

    def GetInput(self) -> vtkPolyData | None:
        """The shape; None where there is none yet."""
        return self.GetInputDataObject(0, 0) if self.GetNumberOfInputConnections(0) else None

    def GetOutput(self, port: int = 0) -> vtkPolyData:
        """The output at a port."""
        return self.GetOutputDataObject(port)

    input_data = property(GetInput, SetInputData, doc="The shape, where no filter makes it.")
    output = property(GetOutput, doc="The output at port 0, the mirror.")

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:
        """Runs the detection; VTK calls this."""
        source = vtkPolyData.GetData(inputs[0])
        try:
            result = self._detected(source)
            mirror = vtkPolyData.GetData(outputs, self.MIRROR)
            _set_mirror_meshes(mirror, result, self._options["show_candidates"])
            _set_mirror_fields(mirror.GetFieldData(), result)
        except Cancelled:
            return 1
        except (InvalidInput, InvalidParameter) as error:
            self._report(str(error))
            return 0
        _set_surface_points(vtkPolyData.GetData(outputs, self.SURFACE_POINTS), result)
        mapping = vtkPolyData.GetData(outputs, self.MAPPING)
        mapping.ShallowCopy(source)
        _set_mapping(mapping, result)
        return 1

    def _detected(self, source: vtkPolyData) -> Result:
        name = self._options["method"]
        method = methods().get(name)
        normals = source.GetPointData().GetNormals() if self._options["use_normals"] else None
        if self._options["use_normals"] and not normals and source.GetNumberOfPoints():
            raise InvalidInput(
                "UseNormals is on, but the input has no point normals; compute them first, or do "
                "without"
            )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)  # said below as VTK says it
            result = detect(
                _rows(source.GetPoints() and source.GetPoints().GetData()),
                name,
                faces=_triangles(source) if self._options["use_faces"] else None,
                normals=normals and _rows(normals),
                nonfinite="refuse" if self._options["refuse_nonfinite"] else "skip",
                seed=self._options["seed"],
                threads=self._options["number_of_threads"],
                progress=self._progress,
                **{
                    parameter.name: self._options[_property(name, parameter.name)]
                    for parameter in (method.parameters if method else ())
                },
            )
        count = result.statistics.get("nonfinite_points")
        if count:
            self._warn(f"{count} points are not finite and were left out; they have no partners")
        if "warning" in result.statistics:
            self._warn(result.statistics["warning"])
        return result

    def _progress(self, fraction: float) -> bool:
        self.UpdateProgress(fraction)
        return not self.GetAbortExecute()

    def _report(self, message: str) -> None:
        text = f"ERROR: {type(self).__name__}: {message}\n"
        if self.HasObserver("ErrorEvent"):
            self.InvokeEvent("ErrorEvent", text)
        else:
            vtkOutputWindow.GetInstance().DisplayErrorText(text)

    def _warn(self, message: str) -> None:
        text = f"Warning: {type(self).__name__}: {message}\n"
        if self.HasObserver("WarningEvent"):
            self.InvokeEvent("WarningEvent", text)
        else:
            vtkOutputWindow.GetInstance().DisplayWarningText(text)


def _property(method: str, parameter: str) -> str:
    return f"{method}_{parameter}"


def _camel_case(name: str) -> str:
    return "".join(word[0].upper() + word[1:] for word in name.split("_"))


def _properties() -> dict[str, tuple[Any, str]]:
    """The default and the description of every property, by name."""
    properties: dict[str, tuple[Any, str]] = {
        "method": (next(iter(methods())), "One of: " + ", ".join(methods())),
        "use_normals": (False, "Whether the input's point normals are used, as lines."),
        "use_faces": (
            True,
            "Whether samples of the input's polygons find the mirror, not its points alone.",
        ),
        "refuse_nonfinite": (
            False,
            "Whether points that are not finite are an error, not left out.",
        ),
        "show_candidates": (
            False,
            "Whether the output Mirror has the triangles of the candidates too.",
        ),
        "seed": (0, "Seed of the methods that draw at random."),
        "number_of_threads": (0, "0 means as many as the machine has."),
    }
    for method in methods().values():
        for parameter in method.parameters:
            properties[_property(method.name, parameter.name)] = (
                parameter.default,
                f"{parameter.doc} Allowed: {allowed(parameter)}.",
            )
    return properties


def _add_property(name: str, doc: str) -> None:
    """As VTK wraps its classes: a setter, a getter and, as VTK has it from 9.4 on, a property."""

    def set_value(self: MirrorDetection, *value: Any) -> None:
        new = value[0] if len(value) == 1 else value
        if not np.array_equal(self._options[name], new):
            self._options[name] = new
            self.Modified()

    def get_value(self: MirrorDetection) -> Any:
        return self._options[name]

    set_value.__name__, get_value.__name__ = f"Set{_camel_case(name)}", f"Get{_camel_case(name)}"
    set_value.__doc__ = get_value.__doc__ = doc
    for accessor in (set_value, get_value):
        setattr(MirrorDetection, accessor.__name__, accessor)
    setattr(MirrorDetection, name, property(get_value, set_value, doc=doc))


def _no_attribute(algorithm: MirrorDetection, name: str) -> str:
    return f"{type(algorithm).__name__} has no attribute {name!r}; {_nearest(name)}"


def _nearest(name: str) -> str:
    names = ["input_data", *_properties()]
    near = get_close_matches(name.lower(), names)
    return f"nearest: {', '.join(near)}" if near else f"allowed are {', '.join(names)}"


def _rows(array: vtkDataArray | None) -> NDArray[np.float64]:
    return np.empty((0, 3)) if array is None else vtk_to_numpy(array)


def _triangles(source: vtkPolyData) -> NDArray[np.int64] | None:
    if source.GetNumberOfPolys() + source.GetNumberOfStrips() == 0:
        return None
    for cells in (source.GetPolys(), source.GetStrips()):
        _require_points(vtk_to_numpy(cells.GetConnectivityArray()), source.GetNumberOfPoints())
    divided = vtkTriangleFilter()
    divided.SetInputData(source)
    divided.PassVertsOff()
    divided.PassLinesOff()
    divided.Update()
    corners = divided.GetOutput().GetPolys().GetConnectivityArray()
    return vtk_to_numpy(corners).reshape(-1, 3)


def _require_points(named: NDArray[np.int64], count: int) -> None:
    """VTK's own filters read what a polygon names without asking whether it is there."""
    beyond = named[(named < 0) | (named >= count)]
    if len(beyond):
        raise InvalidInput(f"a polygon names point {beyond[0]}; allowed is 0 to {count - 1}")


def _points(rows: NDArray[np.float64]) -> vtkPoints:
    points = vtkPoints()
    points.SetData(numpyTovtkDataArray(rows))
    return points


def _cells(rows: NDArray[np.int64]) -> vtkCellArray:
    cells = vtkCellArray()
    cells.SetData(rows.shape[1], numpyTovtkDataArray(np.ascontiguousarray(rows).ravel()))
    return cells


def _set_mirror_meshes(output: vtkPolyData, result: Result, with_candidates: bool) -> None:
    ranked = [result, *(result.candidates if with_candidates else [])]
    drawn = [
        (rank, each.score, each.mirror)
        for rank, each in enumerate(ranked)
        if each.mirror is not None
    ]
    if not drawn:
        return
    vertices, triangles = zip(*(mirror.mesh() for *_, mirror in drawn))
    first_vertices = np.cumsum([0, *map(len, vertices[:-1])])
    corners = [rows + first for rows, first in zip(triangles, first_vertices)]
    counts = [len(rows) for rows in triangles]
    output.SetPoints(_points(np.vstack(vertices)))
    output.SetPolys(_cells(np.vstack(corners)))
    ranks = np.repeat(np.array([rank for rank, *_ in drawn], np.int32), counts)
    scores = np.repeat([score for _, score, _ in drawn], counts)
    output.GetCellData().AddArray(numpyTovtkDataArray(ranks, "Rank"))
    output.GetCellData().AddArray(numpyTovtkDataArray(scores, "Score"))


def _set_mirror_fields(field: vtkFieldData, result: Result) -> None:
    values = result.statistics | {"method": result.method, "score": result.score}
    values |= _candidate_values(result.candidates)
    if result.mirror is not None:
        values |= {"kind": result.mirror.kind} | result.mirror.numbers
    for name, value in values.items():
        _add_field(field, _camel_case(name), value)


def _candidate_values(candidates: list[Result]) -> dict[str, Any]:
    """By name, a row a candidate."""
    if not candidates:
        return {}
    values = {"candidate_scores": np.array([[candidate.score] for candidate in candidates])}
    planes = [each.mirror for each in candidates if isinstance(each.mirror, Plane)]
    if len(planes) == len(candidates):
        values["candidate_normals"] = np.array([plane.normal for plane in planes])
        values["candidate_offsets"] = np.array([[plane.offset] for plane in planes])
    return values


def _add_field(field: vtkFieldData, name: str, value: Any) -> None:
    if isinstance(value, str):
        array = vtkStringArray()
        array.InsertNextValue(value)
    else:
        rows = np.atleast_2d(np.asarray(value, np.int64 if isinstance(value, bool) else None))
        array = numpyTovtkDataArray(np.ascontiguousarray(rows))
    array.SetName(name)
    field.AddArray(array)


def _set_surface_points(output: vtkPolyData, result: Result) -> None:
    output.SetPoints(_points(result.surface_points))
    output.SetVerts(_cells(np.arange(len(result.surface_points), dtype=np.int64)[:, None]))
    output.GetPointData().SetScalars(numpyTovtkDataArray(result.residuals, "Residual"))


def _set_mapping(output: vtkPolyData, result: Result) -> None:
    count = output.GetNumberOfPoints()
    partners, residuals = np.full(count, -1, np.int64), np.full(count, np.nan)
    partners[result.pairs[:, 0]] = result.pairs[:, 1]
    residuals[result.pairs[:, 0]] = result.residuals
    sides = np.zeros(count, np.int8)
    if result.mirror is not None:
        points = _rows(output.GetPoints().GetData())
        distances = result.mirror.signed_distance(points)
        distances[~np.isfinite(points).all(axis=1)] = np.nan
        sides = np.nan_to_num(np.sign(distances)).astype(np.int8)
    data = output.GetPointData()
    data.AddArray(numpyTovtkDataArray(partners, "MirrorPartner"))
    data.AddArray(numpyTovtkDataArray(sides, "MirrorSide"))
    data.SetScalars(numpyTovtkDataArray(residuals, "MirrorResidual"))


for _name, (_, _doc) in _properties().items():
    _add_property(_name, _doc)
