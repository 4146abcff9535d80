"""Runs every operation by its proxy, over a mirror that is connected and without one.

Arguments: the answer file, a folder for the arrays, the proxies' names.
"""

import os
import sys

import numpy as np
from paraview import simple
from session import answer, fetched, field, lopsided, point_array
from vtkmodules.util.numpy_support import vtk_to_numpy

shape = lopsided(simple.Sphere())
detection = simple.MirrorDetection(Input=shape, Method="plane")


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData())


answers = {}
for name in sys.argv[3:]:
    make = getattr(simple, name)
    connected = make(Input=shape, Mirror=detection[1])
    made = fetched(connected)
    data = made.GetPointData()
    arrays = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
    np.savez(
        os.path.join(sys.argv[2], name),
        points=points_of(made),
        **{array: point_array(made, array) for array in arrays},
    )
    alone = points_of(fetched(make(Input=shape, Method="plane")))
    # What is cut along mirrors that differ by rounding may have other points.
    is_alike = alone.shape == points_of(made).shape
    ports = connected.SMProxy.GetNumberOfOutputPorts()
    answers[name] = {
        "field": field(made),
        "cells": made.GetNumberOfCells(),
        "scalars": data.GetScalars().GetName() if data.GetScalars() else None,
        "apart": float(np.abs(alone - points_of(made)).max()) if is_alike else None,
        "ports": [connected.SMProxy.GetOutputPortName(port) for port in range(ports)],
    }
given = fetched(shape)
polygons = vtk_to_numpy(given.GetPolys().GetConnectivityArray()).reshape(-1, 3)
np.savez(os.path.join(sys.argv[2], "shape"), points=points_of(given), faces=polygons)
answer(
    {
        "operations": answers,
        "cells": given.GetNumberOfCells(),
        "mirror": field(fetched(detection, 1)),
    }
)
