"""Takes the picture of a shape coloured by its asymmetry for docs/paraview.md: the colours are those
that the filter brings.

SYMSURF_PLUGIN=.../SymsurfPlugin.so xvfb-run -a pvpython docs/pictures/paraview_asymmetry.py PICTURE
"""

import os
import sys

from paraview import simple
from swollen_head import SCRIPT

simple.LoadPlugin(os.environ["SYMSURF_PLUGIN"], remote=False, ns=vars(simple))
shape = simple.ProgrammableSource(Script=SCRIPT)
detection = simple.MirrorDetection(Input=shape, Method="plane")
asymmetry = simple.MirrorAsymmetry(Input=shape, Mirror=detection[1])

view = simple.CreateRenderView(ViewSize=[1200, 800], OrientationAxesVisibility=0)
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
shown = simple.Show(simple.GenerateSurfaceNormals(Input=asymmetry), view)
simple.ColorBy(shown, ("POINTS", "MirrorAsymmetrySigned"))
shown.SetScalarBarVisibility(view, True)
bar = simple.GetScalarBar(simple.GetColorTransferFunction("MirrorAsymmetrySigned"), view)
bar.Title, bar.ComponentTitle = "Signed asymmetry", ""
bar.TitleColor = bar.LabelColor = [0, 0, 0]
bar.WindowLocation = "Lower Center"
bar.Orientation = "Horizontal"

view.CameraPosition = [1.2, -6, 2.4]
view.CameraFocalPoint = [0, 0, -0.15]
view.CameraViewUp = [0, 0, 1]
view.CameraViewAngle = 30
simple.SaveScreenshot(sys.argv[1], view, ImageResolution=[1200, 800])
