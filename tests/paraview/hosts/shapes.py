"""Detects the mirror of a mesh, and of the same shape as a grid and as blocks; of an image."""

from paraview import simple
from session import answer, fetched, field, lopsided


def found(shape):
    # Of an input by keyword ParaView takes the arrays of the active source for those of the image.
    detection = simple.MirrorDetection(shape, Method="plane")
    fields = field(fetched(detection, 1))
    return {
        "threshold": detection.ImageThreshold,
        "normal": fields["Normal"],
        "offset": fields["Offset"][0],
        "verdict": fields["Verdict"],
        "points": fetched(detection).GetNumberOfPoints(),
    }


mesh = lopsided(simple.Sphere())
halves = mesh.Input.Input  # before they are appended
image = simple.Wavelet()  # RTData is even in z, and odd in parts of x and y
image.UpdatePipeline()
low, high = image.PointData["RTData"].GetRange()
answer(
    {
        "mesh": found(mesh),
        "grid": found(mesh.Input),
        "blocks": found(simple.GroupDatasets(Input=list(halves))),
        "image": found(image) | {"middle": (low + high) / 2},
    }
)
