"""The analyses: symmetries other than one mirror."""

from __future__ import annotations

import warnings
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .._core import Analysis, InvalidParameter, analyses
from ..base.input_warning import InputWarning
from ..results import AnalysisResult
from ..shape_analyses.analyse import analyse
from ..shapes import Shape
from ..shapes.poly_data import faces_of, points_of, rows_of, vtk_points
from .algorithm import REFUSE_NONFINITE, THREADS, Algorithm, Property, selected
from .arrays import add_values, set_vertices, vtk_cells
from .names import camel_case


class SymmetryAnalysis(Algorithm):
    """Finds symmetries of a shape other than one mirror; ``vtkSymmetryAnalysis`` in Python.

    Output 0 "Shape": the input; point data: what the analysis gives each point, in arrays that begin
    with its title; field data: Analysis and its statistics. Output 1 "Elements": mirror planes as
    triangles and axes of rotation as lines; cell data ElementKind, ElementIndex and ElementOrder (0:
    any turn). Output 2 "Transformations": a vertex for each, at the image of the centroid of what it
    maps; point data Kind, Score, Matrix (16 numbers, row by row), FromPoints and OntoPoints.

    Input 1, ``other_data``, is the second of two shapes: for ``match_pair`` alone.

    Points that are not finite are left out, with a warning; in arrays they have NaN, -1 or 0.
    """

    SHAPE, ELEMENTS, TRANSFORMATIONS = range(3)
    _output_count = 3
    _optional_inputs = (1,)
    _inputs: ClassVar = {
        **Algorithm._inputs,
        "other_data": "The second of two shapes, where no filter makes it.",
    }
    _properties = selected(
        "analysis",
        "Which symmetries are sought.",
        analyses(),
        {
            "use_faces": Property(
                True, "Whether the input's polygons are used, not its points alone."
            ),
            "colour_array": Property(
                "",
                "The name of the point array, of any number of components, whose colours "
                "``symmetries_texture`` compares. Empty, or None: the active scalars.",
            ),
            "refuse_nonfinite": REFUSE_NONFINITE,
            "number_of_threads": THREADS,
        },
    )

    def _run(self, inputs: list[Any], outputs: list[vtkPolyData]) -> None:
        source, other = inputs
        shape, elements, transformations = outputs
        options = self._options
        chosen = self._chosen("analysis", analyses())
        colours = _colours(source, options["colour_array"]) if chosen.get("texture") else None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)  # said below as VTK says it
            result = analyse(
                options["analysis"],
                self._shape(source),
                None if other is None else self._shape(other),
                nonfinite="refuse" if options["refuse_nonfinite"] else "skip",
                threads=options["number_of_threads"],
                progress=self._progress,
                colours=colours,
                **chosen,
            )
        self._warn_of(result.statistics)
        shape.ShallowCopy(source)
        _add_arrays(shape, analyses()[result.analysis], result)
        add_values(shape.GetFieldData(), result.statistics | {"analysis": result.analysis})
        _set_elements(elements, result)
        _set_transformations(transformations, result)

    def _shape(self, data: vtkPolyData) -> Shape:
        faces = faces_of(data).corners if self._options["use_faces"] else None
        return Shape(points_of(data), faces)


def _colours(shape: vtkPolyData, name: str) -> NDArray[Any]:
    data = shape.GetPointData()
    array = data.GetArray(name)
    is_active = name == "" or (name == "None" and array is None)
    if is_active:
        array = data.GetScalars()
    if array is None:
        raise InvalidParameter(
            "ColourArray is empty, and no scalars are active; texture needs colours"
            if is_active
            else f"ColourArray is {name!r}, which the input has no point array of"
        )
    return rows_of(array)


def _add_arrays(shape: vtkPolyData, analysis: Analysis, result: AnalysisResult) -> None:
    prefix = camel_case(analysis.title.replace(" ", "_"))
    data = shape.GetPointData()
    for name, values in result.arrays.items():
        kept = values.astype(np.int8) if values.dtype == np.bool_ else values
        data.AddArray(numpyTovtkDataArray(kept, prefix + camel_case(name)))
    if analysis.shown in result.arrays:
        data.SetActiveScalars(prefix + camel_case(analysis.shown))


def _set_elements(output: vtkPolyData, result: AnalysisResult) -> None:
    points = [axis.ends for axis in result.axes]
    kinds = ["axis"] * len(points)
    indices = list(range(len(points)))
    orders = [axis.order for axis in result.axes]
    triangles, first = [], 2 * len(points)
    for index, plane in enumerate(result.planes):
        vertices, corners = plane.mesh(resolution=1)
        points.append(vertices)
        triangles.append(corners + first)
        first += len(vertices)
        kinds += ["plane"] * len(corners)
        indices += [index] * len(corners)
        orders += [2] * len(corners)
    if points:
        output.SetPoints(vtk_points(np.vstack(points)))
    if result.axes:
        output.SetLines(vtk_cells(np.arange(2 * len(result.axes), dtype=np.int64).reshape(-1, 2)))
    if triangles:
        output.SetPolys(vtk_cells(np.vstack(triangles)))
    data = output.GetCellData()
    data.AddArray(_strings("ElementKind", kinds))
    data.AddArray(numpyTovtkDataArray(np.array(indices, np.int64), "ElementIndex"))
    data.AddArray(numpyTovtkDataArray(np.array(orders, np.int64), "ElementOrder"))


def _set_transformations(output: vtkPolyData, result: AnalysisResult) -> None:
    found = result.transformations
    set_vertices(output, np.array([each.place for each in found]).reshape(-1, 3))
    data = output.GetPointData()
    data.AddArray(_strings("Kind", [each.kind for each in found]))
    for name, values, width in (
        ("Score", [each.score for each in found], 1),
        ("Matrix", [each.matrix.ravel() for each in found], 16),
    ):
        rows = np.array(values, np.float64).reshape(len(found), width)
        data.AddArray(numpyTovtkDataArray(rows, name))
    for name, counts in (
        ("FromPoints", [len(each.from_points) for each in found]),
        ("OntoPoints", [len(each.onto_points) for each in found]),
    ):
        data.AddArray(numpyTovtkDataArray(np.array(counts, np.int64), name))


def _strings(name: str, values: list[str]) -> vtkStringArray:
    array = vtkStringArray()
    array.SetName(name)
    for value in values:
        array.InsertNextValue(value)
    return array
