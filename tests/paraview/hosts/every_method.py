"""Runs every method of the Method property on a file and on a known mirror."""

import sys

from paraview import simple
from session import answer, fetched, field, lopsided, point_array

source = simple.OpenDataFile(sys.argv[2]) if len(sys.argv) > 2 else lopsided(simple.Sphere())
detection = simple.MirrorDetection(Input=source)
answers = {}
for method in detection.GetProperty("Method").Available:
    detection.Method = method
    detection.UpdatePipeline()
    shape, mirror, surface = (fetched(detection, port) for port in range(3))
    answers[method] = {
        "field": field(mirror),
        "triangles": mirror.GetNumberOfPolys(),
        "surface_points": surface.GetNumberOfPoints(),
        "vertices": surface.GetNumberOfVerts(),
        "residuals": len(point_array(surface, "Residual")),
        "points": source.GetDataInformation().GetNumberOfPoints(),
        "partners": len(point_array(shape, "MirrorPartner")),
        "paired": int((point_array(shape, "MirrorPartner") >= 0).sum()),
        "sides": sorted(set(point_array(shape, "MirrorSide").tolist())),
    }
ports = [detection.SMProxy.GetOutputPortName(port) for port in range(3)]
answer({"methods": answers, "ports": ports})
