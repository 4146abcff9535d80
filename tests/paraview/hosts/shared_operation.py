"""An operation on points that the processes share out, and on the same points in one process; tells
how many points each gives."""

from paraview import simple
from session import answer, is_client, lopsided

shape = lopsided(simple.Sphere(ThetaResolution=24, PhiResolution=24))
detection = simple.MirrorDetection(Input=shape, Method="plane")


def points_of(source):
    asymmetry = simple.MirrorAsymmetry(Input=source, Mirror=detection[1])
    asymmetry.UpdatePipeline()
    return asymmetry.GetDataInformation().GetNumberOfPoints()


gathered = simple.AggregateDataset(Input=shape, NumberOfTargetProcesses=1)
answers = {"shared": points_of(shape), "gathered": points_of(gathered)}
gathered.UpdatePipeline()
answers["points"] = gathered.GetDataInformation().GetNumberOfPoints()
if is_client():
    answer(answers)
