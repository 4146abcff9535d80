"""What the scripts of this folder share: the plugin, an answer file, data as plain numbers."""

import json
import os
import sys

from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

simple.LoadPlugin(os.environ["SYMSURF_PLUGIN"], remote=False, ns=vars(simple))


def is_client():
    """Whether this process is the one that sees the data of all."""
    return servermanager.vtkProcessModule.GetProcessModule().GetPartitionId() == 0


def answer(values):
    """Leaves the script's answer."""
    with open(sys.argv[1], "w") as file:
        json.dump(values, file)


def fetched(proxy, port=0):
    """The data at an output port, of all ranks, here."""
    proxy.UpdatePipeline()
    return servermanager.Fetch(proxy, idx=port)


def field(data):
    """A data set's field data as lists and strings, by name."""
    fields = data.GetFieldData()
    arrays = [fields.GetAbstractArray(i) for i in range(fields.GetNumberOfArrays())]
    return {
        array.GetName(): array.GetValue(0)
        if array.IsA("vtkStringArray")
        else vtk_to_numpy(array).ravel().tolist()
        for array in arrays
    }


def point_array(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def lopsided(source):
    """Half of a shape made lopsided and its reflection over x = 0.25: a known mirror."""
    bent = simple.Calculator(
        Input=source,
        CoordinateResults=1,
        Function="coords * (1 + 0.3*sin(3*coordsX + coordsY) + 0.2*coordsY*coordsZ)",
    )
    reflected = simple.Transform(Input=bent)
    reflected.Transform.Scale = [-1, 1, 1]
    reflected.Transform.Translate = [0.5, 0, 0]
    both = simple.AppendDatasets(Input=[bent, reflected])
    return simple.ExtractSurface(Input=both)
