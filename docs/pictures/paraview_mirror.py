"""Takes the picture of a shape, its mirror and its asymmetry for docs/paraview.md.

SYMSURF_PLUGIN=.../SymsurfPlugin.so xvfb-run -a pvpython docs/pictures/paraview_mirror.py PICTURE
"""

import os
import sys

from paraview import simple

SHAPE = """
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

simple.LoadPlugin(os.environ["SYMSURF_PLUGIN"], remote=False, ns=vars(simple))
shape = simple.ProgrammableSource(Script=SHAPE)
detection = simple.MirrorDetection(Input=shape, Method="plane")

view = simple.CreateRenderView(ViewSize=[1200, 800], OrientationAxesVisibility=0)
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]

mapping = simple.Show(simple.GenerateSurfaceNormals(Input=detection[2]), view)
simple.ColorBy(mapping, ("POINTS", "MirrorResidual"))
colours = simple.GetColorTransferFunction("MirrorResidual")
colours.ApplyPreset("Cool to Warm", True)
colours.RescaleTransferFunction(0, 0.14)
mapping.SetScalarBarVisibility(view, True)
bar = simple.GetScalarBar(colours, view)
bar.Title, bar.ComponentTitle = "Distance from the image to its partner", ""
bar.TitleColor = bar.LabelColor = [0, 0, 0]
bar.WindowLocation = "Lower Center"
bar.Orientation = "Horizontal"

mirror = simple.Show(detection[0], view)
mirror.ColorArrayName = ["POINTS", ""]
mirror.DiffuseColor = mirror.AmbientColor = [0.2, 0.55, 0.3]
mirror.Opacity = 0.45
mirror.Representation = "Surface"

view.CameraPosition = [3.4, -5.2, 2.4]
view.CameraFocalPoint = [0, 0, -0.15]
view.CameraViewUp = [0, 0, 1]
view.CameraViewAngle = 30
simple.SaveScreenshot(sys.argv[1], view, ImageResolution=[1200, 800])
