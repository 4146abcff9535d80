"""The script of a ProgrammableSource: a head-like shape with a swollen cheek, mirrored over x = 0."""

SCRIPT = """
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray

def unit(*direction):
    return np.array(direction) / np.linalg.norm(direction)

around, up = 360, 180
a, b = np.meshgrid(np.linspace(0, 2 * np.pi, around, endpoint=False), np.linspace(0, np.pi, up), indexing="ij")
x = np.stack([np.cos(a) * np.sin(b), np.sin(a) * np.sin(b), np.cos(b)], -1).reshape(-1, 3)
def bump(direction, width, height):
    return height * np.exp((x @ unit(*direction) - 1) / width)

radius = 1 + 0.15 * np.sin(2 * x[:, 1] + x[:, 2])
for side in (-1, 1):
    radius += bump((side * 0.9, 0.1, 0.8), 0.03, 0.55)
    radius += bump((side * 0.8, -1, -0.3), 0.05, 0.35)
radius += bump((0, -1, 0.25), 0.02, 0.4)
radius += bump((0.75, -0.5, 0.1), 0.03, 0.14)  # on one side only
points = vtkPoints()
points.SetData(numpy_to_vtk(x * radius[:, None] * (1, 1.2, 1.1), deep=True))
i, j = np.meshgrid(np.arange(around), np.arange(up - 1), indexing="ij")
corners = [i * up + j, i * up + j + 1, (i + 1) % around * up + j + 1, (i + 1) % around * up + j]
faces = np.stack([c.ravel() for c in corners], -1).astype(np.int64)
cells = vtkCellArray()
cells.SetData(4, numpy_to_vtkIdTypeArray(faces.ravel(), deep=True))
output = self.GetPolyDataOutput()
output.SetPoints(points)
output.SetPolys(cells)
"""
