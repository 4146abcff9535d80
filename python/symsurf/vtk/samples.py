"""Points whose mirror is known."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .. import _core
from ..shapes.poly_data import points_of, vtk_points
from .algorithm import Algorithm, selected
from .arrays import add_values, set_vertices, vtk_cells


class MirrorSampleSource(Algorithm):
    """Makes points whose mirror is known; ``vtkMirrorSampleSource`` in Python.

    An optional input gives the points that the generators "fixed" and "spherical" mirror; without one
    they sample a surface. Output 0 "Sample": the points, then their images, a vertex each; point data
    MirrorPartner, the index of the image or of the point it is the image of (-1 for none). Output 1
    "Mirror": triangles of the true mirror; field data Kind and the numbers that define it.
    """

    SAMPLE, MIRROR = range(2)
    _output_count = 2
    _optional_inputs = (0,)
    _inputs: ClassVar = {"input_data": "The points to mirror, where no filter makes them."}
    _properties = selected("generator", "How the points are made.", _core.generators())

    def _run(self, inputs: list[Any], outputs: list[vtkPolyData]) -> None:
        (given,) = inputs
        sample, mirror = outputs
        points, truth, pairs, _ = _core.generate(
            self._options["generator"],
            self._chosen("generator", _core.generators()),
            None if given is None else points_of(given),
        )
        set_vertices(sample, points)
        partners = np.full(len(points), -1, np.int64)
        partners[pairs[:, 0]], partners[pairs[:, 1]] = pairs[:, 1], pairs[:, 0]
        sample.GetPointData().AddArray(numpyTovtkDataArray(partners, "MirrorPartner"))

        vertices, triangles = truth.mesh(points)
        mirror.SetPoints(vtk_points(vertices))
        mirror.SetPolys(vtk_cells(triangles))
        add_values(mirror.GetFieldData(), {"kind": truth.kind} | truth.numbers)
