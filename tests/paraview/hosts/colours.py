"""Shows the asymmetry of shapes; tells the ranges of its colours, and its percentile and its maximum."""

import numpy as np
from paraview import simple
from session import answer, fetched, field, lopsided, point_array

NAME = "MirrorAsymmetrySigned"
shape = lopsided(simple.Sphere(ThetaResolution=40, PhiResolution=30))
dented = simple.Calculator(
    Input=shape,
    CoordinateResults=1,
    Function="coords * (1 - 0.2*exp(-40*((coordsX-0.5)^2 + coordsY^2 + coordsZ^2)))",
)
view = simple.CreateRenderView()


def colours():
    points = simple.GetColorTransferFunction(NAME).RGBPoints
    return [points[0], points[-4]]


def colour_of_0():
    points = np.reshape(simple.GetColorTransferFunction(NAME).RGBPoints, (-1, 4))
    return [float(np.interp(0, points[:, 0], points[:, i])) for i in (1, 2, 3)]


def shown(depth):
    """The range of the colours once a shape with such a dent is shown, and what it follows."""
    dented.Function = dented.Function.replace(shown.depth, depth)
    shown.depth = depth
    simple.Show(asymmetry, view)
    simple.Render(view)
    made = fetched(asymmetry)
    largest = float(np.nanmax(np.abs(point_array(made, NAME))))
    return {
        "colours": colours(),
        "of 0": colour_of_0(),
        "p99": field(made)["P99"][0],
        "largest": largest,
    }


shown.depth = "0.2"
asymmetry = simple.MirrorAsymmetry(Input=dented, Mirror=simple.MirrorDetection(Input=shape)[1])
answers = {depth: shown(depth) for depth in ("0.2", "0.1", "0.3")}
table = simple.GetColorTransferFunction(NAME)
table.RescaleTransferFunction(0, 1)  # as a user may
answers["own"] = shown("0.4")
representation = simple.GetRepresentation(asymmetry, view)
answers["nan"] = list(table.NanColor)
answers["legend"] = simple.GetScalarBar(table, view).Title
answers["array"] = list(representation.ColorArrayName)
answer(answers)
