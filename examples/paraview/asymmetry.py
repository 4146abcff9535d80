"""Maps the asymmetry of a shape in ParaView's Python.

SYMSURF_PLUGIN=.../SymsurfPlugin.so pvpython asymmetry.py face.ply asymmetry.png
"""

import os
import sys

from paraview.simple import *

LoadPlugin(os.environ["SYMSURF_PLUGIN"], remote=False, ns=globals())

face = OpenDataFile(sys.argv[1])
detection = MirrorDetection(Input=face, Method="plane")
asymmetry = MirrorAsymmetry(Input=face, Mirror=detection[1])

asymmetry.UpdatePipeline()
figures = servermanager.Fetch(asymmetry).GetFieldData()
print("rms", round(figures.GetArray("Rms").GetValue(0), 2))
print("maximum", round(figures.GetArray("Maximum").GetValue(0), 2))

view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [900, 700]
view.OrientationAxesVisibility = 0
shown = Show(asymmetry, view)
ColorBy(shown, ("POINTS", "MirrorAsymmetrySigned"))
shown.SetScalarBarVisibility(view, True)
mirror = Show(detection[1], view)
mirror.Representation = "Surface"
mirror.Opacity = 0.3
view.ResetActiveCameraToNegativeY()
ResetCamera()
GetActiveCamera().Azimuth(-155)
SaveScreenshot(sys.argv[2], view, OverrideColorPalette="WhiteBackground")
