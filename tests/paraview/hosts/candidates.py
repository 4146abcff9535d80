"""The planes of a box with all candidates shown: field data, and each mirror by its rank."""

from paraview import simple
from session import answer, fetched, field

box = simple.Box(XLength=1, YLength=2, ZLength=3)
detection = simple.MirrorDetection(Input=box, Method="plane")
alone = fetched(detection, 1).GetNumberOfPolys()
detection.ShowCandidates = 1
mirror = fetched(detection, 1)
ranks = mirror.GetCellData().GetArray("Rank").GetRange()
chosen = simple.Threshold(Input=detection[1], Scalars=["CELLS", "Rank"])
bounds = []
for rank in range(int(ranks[1]) + 1):
    chosen.LowerThreshold = chosen.UpperThreshold = rank
    bounds.append(fetched(chosen).GetBounds())
answer(
    {
        "alone": alone,
        "all": mirror.GetNumberOfPolys(),
        "scores": mirror.GetCellData().GetArray("Score").GetRange(),
        "field": field(mirror),
        "bounds": bounds,
    }
)
