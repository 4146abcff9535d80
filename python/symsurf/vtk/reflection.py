"""The reflection of a shape over its mirror."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithmOutput
from vtkmodules.vtkFiltersCore import vtkReverseSense

from ..reflection import carry_over
from ..shapes.poly_data import kinds_of, points_of
from .algorithm import Algorithm
from .arrays import mirror_of, set_subset, turn_rows


class MirrorReflection(Algorithm):
    """Reflects a shape over a mirror; ``vtkMirrorReflection`` in Python.

    Input 0 is what is reflected, input 1 the mirror: output 1 of ``MirrorDetection``, whose field
    data says everything. Cells are turned over, so that the outside stays the outside; active vectors,
    normals and tensors of points are reflected, too, normals of cells are not passed on. Points that
    have no image over the mirror are left out, together with the cells that need them.
    """

    _inputs: ClassVar = {
        "input_data": "What is reflected, where no filter makes it.",
        "mirror_data": 'The output "Mirror" of a detection, where no filter makes it.',
    }

    def SetMirrorConnection(self, mirror: vtkAlgorithmOutput) -> None:
        """Connects the mirror, input 1."""
        self.SetInputConnection(1, mirror)

    def _run(self, inputs: list[Any], outputs: list[vtkPolyData]) -> None:
        shape, mirror = inputs
        over, points = mirror_of(mirror), points_of(shape)
        images = over.reflect(points)
        kept = np.flatnonzero(np.isfinite(images).all(axis=1))
        reflected = vtkPolyData()
        set_subset(reflected, shape, images[kept], kept)
        reflected.GetCellData().SetNormals(None)
        if kinds_of(shape.GetPointData()):
            turn_rows(reflected.GetPointData(), carry_over(over, points[kept]))
        reverse = vtkReverseSense()
        reverse.SetInputData(reflected)
        reverse.ReverseCellsOn()
        reverse.Update()
        outputs[0].ShallowCopy(reverse.GetOutput())
