"""Reflects a shape over its mirror; tells how far partners then are, beyond their residuals."""

import numpy as np
from paraview import simple
from session import answer, fetched, lopsided, point_array
from vtkmodules.util.numpy_support import vtk_to_numpy

detection = simple.MirrorDetection(Input=lopsided(simple.Sphere()), Method="plane")
reflection = simple.MirrorReflection(Input=detection, Mirror=detection[1])
reflected = fetched(reflection)
points = vtk_to_numpy(fetched(detection).GetPoints().GetData())
partners = point_array(reflected, "MirrorPartner")
paired = partners >= 0
gaps = vtk_to_numpy(reflected.GetPoints().GetData())[paired] - points[partners[paired]]
residuals = point_array(reflected, "MirrorResidual")[paired]
answer(float(np.abs(np.linalg.norm(gaps, axis=1) - residuals).max()))
