"""Measures the asymmetry of a ball with a dent of depth 0.1 after its mirror is detected, with default
connections and over the known mirror; tells what filters say where a mirror is no shape, and where a
shape is no mirror."""

from bad_tables_data import mirror_of, source_of
from paraview import simple
from session import answer, fetched, field

ball = simple.Calculator(
    Input=simple.Sphere(ThetaResolution=60, PhiResolution=40, Radius=1),
    CoordinateResults=1,
    Function="coords * (1 + 0.1*sin(3*coordsY + 1) + 0.1*coordsZ*coordsX^2"
    " - 0.1*exp(-((coordsX - 0.8)^2 + (coordsY - 0.6)^2 + coordsZ^2)/0.1))",
)
detection = simple.MirrorDetection(Input=ball, Method="plane")
known = source_of(mirror_of("plane", {"normal": (1.0, 0.0, 0.0), "offset": 0.0}))


def said(proxy):
    messages = []

    def heard(_caller, _event, text):
        messages.append(text)

    heard.CallDataType = "string0"
    proxy.GetClientSideObject().AddObserver("ErrorEvent", heard)
    proxy.UpdatePipeline()
    return "".join(messages)


answer(
    {
        "found": field(fetched(simple.MirrorAsymmetry(Input=detection, Method="plane"))),
        "known": field(fetched(simple.MirrorAsymmetry(Input=ball, Mirror=known))),
        "no shape": said(simple.MirrorAsymmetry(Input=detection[1])),
        "no mirror": said(simple.MirrorReflection(Input=ball, Mirror=detection)),
    }
)
