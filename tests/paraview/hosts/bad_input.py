"""Everything that can be wrong with the input or a parameter, in one session."""

from paraview import simple
from session import answer, fetched, lopsided

good = lopsided(simple.Sphere())
line = simple.Line(Resolution=5)
point = simple.PointSource(NumberOfPoints=1)
nothing = simple.Threshold(
    Input=good, LowerThreshold=10, UpperThreshold=11, Scalars=["POINTS", "Normals"]
)
nothing = simple.ExtractSurface(Input=nothing)
broken = simple.Calculator(Input=good, CoordinateResults=1, Function="coords / (coordsX - coordsX)")

SOME_ARE_NOT_FINITE = """
from vtkmodules.vtkCommonCore import vtkPoints

points = vtkPoints()
points.DeepCopy(self.GetPolyDataInput().GetPoints())
for i in range(0, points.GetNumberOfPoints(), 50):
    points.SetPoint(i, float("nan"), 0, 0)
self.GetPolyDataOutput().ShallowCopy(self.GetPolyDataInput())
self.GetPolyDataOutput().SetPoints(points)
"""

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
partly = simple.ProgrammableFilter(Input=good, Script=SOME_ARE_NOT_FINITE)
run("refused", partly, RefuseNonfinite=1)
run("good, but for some", partly)
run("parameter", good, PlanePairDistance=-1)
run("threads", good, NumberOfThreads=-3)
try:
    simple.MirrorDetection(Input=simple.Wavelet()).UpdatePipeline()
except RuntimeError:
    pass  # ParaView refuses the type
run("good again", good)
answer(points)
