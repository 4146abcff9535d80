"""Shows the mirrors of prisms; tells how they are shown at first, and the titles of the legends."""

from paraview import simple
from session import answer

view = simple.CreateRenderView()


def seen(source, port, array):
    shown = simple.Show(source[port], view)
    simple.Render(view)
    title = simple.GetScalarBar(simple.GetColorTransferFunction(array), view).Title
    return {"opacity": shown.Opacity, "array": list(shown.ColorArrayName), "legend": title}


prism = simple.Cylinder(Resolution=6)
several = simple.MirrorDetection(Input=prism, Method="plane", ShowCandidates=1)
one = simple.MirrorDetection(Input=prism, Method="plane")
shown = simple.Show(one[1], view)
shown.Opacity = 0.9  # as a user may
one.ShowCandidates = 0
simple.Show(one[1], view)
answer(
    {
        "shape": seen(several, 0, "MirrorResidual"),
        "several": seen(several, 1, "Rank"),
        "own": shown.Opacity,
        "elements": seen(simple.SymmetryAnalysis(Input=prism), 1, "ElementOrder"),
        "one": list(shown.ColorArrayName),
    }
)
