"""Takes the picture of a shape, its mirror and its asymmetry for docs/paraview.md.

SYMSURF_PLUGIN=.../SymsurfPlugin.so xvfb-run -a pvpython docs/pictures/paraview_mirror.py PICTURE
"""

import os
import sys

from paraview import simple
from swollen_head import SCRIPT

simple.LoadPlugin(os.environ["SYMSURF_PLUGIN"], remote=False, ns=vars(simple))
shape = simple.ProgrammableSource(Script=SCRIPT)
detection = simple.MirrorDetection(Input=shape, Method="plane")

view = simple.CreateRenderView(ViewSize=[1200, 800], OrientationAxesVisibility=0)
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]

head = simple.Show(simple.GenerateSurfaceNormals(Input=detection), view)
simple.ColorBy(head, ("POINTS", "MirrorResidual"))
colours = simple.GetColorTransferFunction("MirrorResidual")
colours.ApplyPreset("Cool to Warm", True)
colours.RescaleTransferFunction(0, 0.14)
head.SetScalarBarVisibility(view, True)
bar = simple.GetScalarBar(colours, view)
bar.TitleColor = bar.LabelColor = [0, 0, 0]
bar.WindowLocation = "Lower Center"
bar.Orientation = "Horizontal"

simple.Show(detection[1], view)

view.CameraPosition = [3.4, -5.2, 2.4]
view.CameraFocalPoint = [0, 0, -0.15]
view.CameraViewUp = [0, 0, 1]
view.CameraViewAngle = 30
simple.SaveScreenshot(sys.argv[1], view, ImageResolution=[1200, 800])
