"""Everything that can be wrong with the input or a parameter, in one session."""

from paraview import simple
from session import answer, fetched, lopsided

good = lopsided(simple.Sphere())
line = simple.Line(Resolution=5)
point = simple.PointSource(NumberOfPoints=1)
nothing = simple.Threshold(Input=good, LowerThreshold=10, UpperThreshold=11, Scalars=["POINTS", "Normals"])
nothing = simple.ExtractSurface(Input=nothing)
broken = simple.Calculator(Input=good, CoordinateResults=1, Function="coords / (coordsX - coordsX)")

points = {}


def run(name, source, **properties):
    detection = simple.MirrorDetection(Input=source, Method="plane")
    for key, value in properties.items():
        detection.SetPropertyWithName(key, value)
    points[name] = fetched(detection).GetNumberOfPoints()


run("good", good)
run("line", line)
run("point", point)
run("nothing", nothing)
run("broken", broken)
run("parameter", good, PlanePairDistance=-1)
run("threads", good, NumberOfThreads=-3)
try:
    simple.MirrorDetection(Input=simple.Wavelet()).UpdatePipeline()
except RuntimeError:
    pass  # ParaView refuses the type
run("good again", good)
answer(points)
