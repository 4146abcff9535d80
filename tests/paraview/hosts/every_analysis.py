"""Runs every analysis on a box. Arguments: the answer file, the analyses' names."""

import sys

import numpy as np
from paraview import simple
from session import answer, fetched, field
from vtkmodules.util.numpy_support import vtk_to_numpy

SHAPE, ELEMENTS, TRANSFORMATIONS = range(3)
box = simple.Box(XLength=4, YLength=3, ZLength=2)

answers = {}
for name in sys.argv[2:]:
    other = {"Other": box} if name == "match_pair" else {}
    analysis = simple.SymmetryAnalysis(Input=box, Analysis=name, **other)
    shape, elements, transformations = (
        fetched(analysis, port) for port in (SHAPE, ELEMENTS, TRANSFORMATIONS)
    )
    data = shape.GetPointData()
    matrices = transformations.GetPointData().GetArray("Matrix")
    answers[name] = {
        "field": field(shape),
        "arrays": [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())],
        "lines": elements.GetNumberOfLines(),
        "determinants": np.linalg.det(vtk_to_numpy(matrices).reshape(-1, 4, 4)[:, :3, :3]).tolist(),
        "ports": [analysis.SMProxy.GetOutputPortName(port) for port in range(3)],
    }
answer(answers)
