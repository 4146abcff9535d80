"""Takes the picture of a prism and all its planes of symmetry for docs/paraview.md.

SYMSURF_PLUGIN=.../SymsurfPlugin.so xvfb-run -a pvpython docs/pictures/paraview_candidates.py PICTURE
"""

import os
import sys

from paraview import simple

simple.LoadPlugin(os.environ["SYMSURF_PLUGIN"], remote=False, ns=vars(simple))
prism = simple.Cylinder(Resolution=3, Height=2.2, Radius=1)
detection = simple.MirrorDetection(Input=prism, Method="plane", ShowCandidates=1)

view = simple.CreateRenderView(ViewSize=[800, 560], OrientationAxesVisibility=0)
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]

edges = simple.Show(simple.FeatureEdges(Input=prism), view)
edges.ColorArrayName = ["POINTS", ""]
edges.DiffuseColor = edges.AmbientColor = [0.1, 0.1, 0.1]
edges.LineWidth = 3

mirrors = simple.Show(detection[1], view)
mirrors.Representation = "Surface"
mirrors.Opacity = 0.6
mirrors.Ambient, mirrors.Diffuse = 0.7, 0.3
simple.ColorBy(mirrors, ("CELLS", "Rank"))
colours = simple.GetColorTransferFunction("Rank")
colours.InterpretValuesAsCategories = 1
colours.Annotations = ["0", "0", "1", "1", "2", "2", "3", "3"]
colours.IndexedColors = [0.9, 0.35, 0.1, 0.1, 0.5, 0.8, 0.2, 0.65, 0.35, 0.55, 0.35, 0.75]
mirrors.SetScalarBarVisibility(view, True)
bar = simple.GetScalarBar(colours, view)
bar.Title, bar.ComponentTitle = "Rank", ""
bar.TitleColor = bar.LabelColor = [0, 0, 0]

view.CameraPosition = [4.7, 3.0, 2.6]
view.CameraFocalPoint = [0, 0, 0]
view.CameraViewUp = [0, 1, 0]
view.CameraViewAngle = 30
simple.SaveScreenshot(sys.argv[1], view, ImageResolution=[800, 560])
