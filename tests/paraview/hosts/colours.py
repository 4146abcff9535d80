"""Shows the asymmetry of shapes; tells the ranges of its colours, and of its values."""

import numpy as np
from paraview import simple
from session import answer, fetched, lopsided, point_array

NAME = "MirrorAsymmetrySigned"
shape = lopsided(simple.Sphere())
dented = simple.Calculator(
    Input=shape,
    CoordinateResults=1,
    Function="coords * (1 - 0.2*exp(-10*((coordsX-0.5)^2 + coordsY^2 + coordsZ^2)))",
)
view = simple.CreateRenderView()


def colours():
    points = simple.GetColorTransferFunction(NAME).RGBPoints
    return [points[0], points[-4]]


def shown(depth):
    """The range of the colours once a shape with such a dent is shown, and of the values."""
    dented.Function = dented.Function.replace(shown.depth, depth)
    shown.depth = depth
    simple.Show(asymmetry, view)
    simple.Render(view)
    values = point_array(fetched(asymmetry), NAME)
    return {"colours": colours(), "values": [float(np.nanmin(values)), float(np.nanmax(values))]}


shown.depth = "0.2"
asymmetry = simple.MirrorAsymmetry(Input=dented, Mirror=simple.MirrorDetection(Input=shape))
answers = {depth: shown(depth) for depth in ("0.2", "0.1", "0.3")}
table = simple.GetColorTransferFunction(NAME)
table.RescaleTransferFunction(0, 1)  # as a user may
answers["own"] = shown("0.4")
representation = simple.GetRepresentation(asymmetry, view)
answers["array"] = list(representation.ColorArrayName)
answer(answers)
