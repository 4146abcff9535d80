"""The shape that a data object of VTK holds."""

from __future__ import annotations

import math
from typing import Any

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet,
    vtkDataObject,
    vtkImageData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkThresholdPoints
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

from .._core import InvalidInput
from ..shapes.poly_data import require_points, require_sound_cells
from .arrays import is_mirror


def shape_of(
    data: vtkDataObject | None,
    algorithm: vtkAlgorithm,
    image_threshold: float,
    image_label: float | None = None,
) -> vtkPolyData | None:
    """Poly data as they are; the surface of other point sets' cells, or their points where they have
    none; of an image the points whose scalar is greater, or is the label; all blocks of a composite as one shape.

    algorithm: its input array to process 0 says which scalars. Raises InvalidInput, also where the
    data are a mirror and where a cell names a point that is not there.
    """
    if data is None:
        return None
    if is_mirror(data):
        raise InvalidInput(
            'the input is a mirror, by its field data array Kind; connect a shape: output 0 "Shape" '
            "of a mirror detection, or what that takes"
        )
    if isinstance(data, vtkPolyData):
        require_sound_cells(data)
        return data
    if isinstance(data, vtkPointSet):
        return _surface_of(data)
    if isinstance(data, (vtkImageData, vtkRectilinearGrid)):
        return _chosen_points(data, algorithm, image_threshold, image_label)
    if isinstance(data, vtkCompositeDataSet):
        return _joined_blocks(data, algorithm, image_threshold, image_label)
    raise InvalidInput(
        f"the input is a {data.GetClassName()}; allowed are vtkPolyData and other point sets, images "
        "and composites of these"
    )


def _surface_of(data: vtkPointSet) -> vtkPolyData:
    if data.GetNumberOfCells() == 0:
        points = vtkPolyData()
        points.SetPoints(data.GetPoints())
        points.GetPointData().ShallowCopy(data.GetPointData())
        points.GetFieldData().ShallowCopy(data.GetFieldData())
        return points
    if isinstance(data, vtkUnstructuredGrid):
        corners = vtk_to_numpy(data.GetCells().GetConnectivityArray())
        require_points(corners, data.GetNumberOfPoints())
    return _made(vtkGeometryFilter(), data)


def _chosen_points(
    image: Any, algorithm: vtkAlgorithm, threshold: float, label: float | None
) -> vtkPolyData:
    if image.GetNumberOfPoints() == 0:
        return vtkPolyData()
    kind = image.GetClassName()
    name = algorithm.GetInputArrayInformation(0).Get(vtkDataObject.FIELD_NAME())
    data = image.GetPointData()
    scalars = data.GetArray(name) if name else data.GetScalars()
    if scalars is None:
        raise InvalidInput(
            f"the {kind} has no point scalars {name or 'that are active'}, which say what of it is the "
            "shape"
        )
    if scalars.GetNumberOfComponents() != 1:
        raise InvalidInput(
            f"the scalars of the {kind} have {scalars.GetNumberOfComponents()} components; allowed is "
            "one"
        )
    copy = image.NewInstance()
    copy.ShallowCopy(image)
    if name:
        copy.GetPointData().SetActiveScalars(name)
    chosen = vtkThresholdPoints()
    chosen.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    least = math.nextafter(threshold, math.inf)  # it takes equal values, too
    lower, upper = (least, math.inf) if label is None else (label, label)
    if hasattr(chosen, "SetThresholdFunction"):
        chosen.SetThresholdFunction(chosen.THRESHOLD_BETWEEN)
        chosen.SetLowerThreshold(lower)
        chosen.SetUpperThreshold(upper)
    else:  # before VTK 9.6
        chosen.ThresholdBetween(lower, upper)
    return _made(chosen, copy)


def _joined_blocks(
    data: vtkCompositeDataSet, algorithm: vtkAlgorithm, threshold: float, label: float | None
) -> vtkPolyData:
    joined = vtkAppendPolyData()
    block = data.NewIterator()
    block.InitTraversal()
    while not block.IsDoneWithTraversal():
        joined.AddInputData(shape_of(block.GetCurrentDataObject(), algorithm, threshold, label))
        block.GoToNextItem()
    if joined.GetNumberOfInputConnections(0) == 0:
        return vtkPolyData()
    joined.Update()
    return joined.GetOutput()


def _made(algorithm: Any, data: vtkDataObject) -> vtkPolyData:
    algorithm.SetInputData(data)
    algorithm.Update()
    return algorithm.GetOutput()
