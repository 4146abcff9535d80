"""Draws each output alone and tells which share of the picture is not background."""

import sys

from paraview import simple
from session import answer, lopsided
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

detection = simple.MirrorDetection(Input=lopsided(simple.Sphere()))
view = simple.CreateRenderView(ViewSize=[300, 300], OrientationAxesVisibility=0)
view.UseColorPaletteForBackground = 0
view.Background = [0, 0, 0]
view.CameraPosition = [3, 2, 2]
view.CameraFocalPoint = [0.25, 0, 0]


def share():
    simple.SaveScreenshot(sys.argv[2], view)
    reader = vtkPNGReader()
    reader.SetFileName(sys.argv[2])
    reader.Update()
    colours = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3]
    return float((colours.max(axis=1) > 40).mean())


shares = {"nothing": share()}
for port, name in enumerate(("Shape", "Mirror", "Surface Points")):
    shown = simple.Show(detection[port], view)
    shares[name] = share()
    simple.Hide(detection[port], view)
answer(shares)
