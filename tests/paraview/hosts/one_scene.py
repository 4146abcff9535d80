"""The mirrors of one scene by the wrapped VTK filter and by ParaView's proxy.

Arguments: the answer file, a file of doubles (three a point), the methods.
"""

import sys

import numpy as np
from paraview import simple
from session import answer, fetched, field
from symsurf_filters import vtkSymsurfFilters
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

points = vtkPoints()
points.SetData(numpy_to_vtk(np.fromfile(sys.argv[2]).reshape(-1, 3), deep=True))
data = vtkPolyData()
data.SetPoints(points)
source = simple.TrivialProducer()
source.GetClientSideObject().SetOutput(data)

answers = {"wrapped": {}, "paraview": {}}
for method in sys.argv[3:]:
    wrapped = vtkSymsurfFilters.vtkMirrorDetection()
    wrapped.SetInputData(data)
    wrapped.SetMethod(method)
    wrapped.Update()
    answers["wrapped"][method] = field(wrapped.GetOutput(wrapped.MIRROR))
    detection = simple.MirrorDetection(Input=source, Method=method)
    answers["paraview"][method] = field(fetched(detection, 1))
answer(answers)
