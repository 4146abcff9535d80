"""Data sets for the tables of bad input, and what a filter says of them."""

import sys
from pathlib import Path

from paraview import simple
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

sys.path.insert(0, str(Path(__file__).parents[2]))
from bad_input import tables

CLOUDS, MIRRORS = tables.clouds(), tables.mirrors()

GOOD = [(x * (1 + y), y, z * z + x) for x in (-2, 2) for y in (0, 1, 3) for z in (0, 1, 4)]


def cloud_of(rows):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    for row in rows:
        points.InsertNextPoint(row)
    data = vtkPolyData()
    data.SetPoints(points)
    return data


def mirror_of(kind, numbers):
    data = vtkPolyData()
    for name, value in {"kind": kind, **numbers}.items():
        array = vtkStringArray() if isinstance(value, str) else vtkDoubleArray()
        if isinstance(value, (str, float)):
            array.InsertNextValue(value)
        else:
            rows = value if isinstance(value, list) else [value]
            array.SetNumberOfComponents(len(rows[0]))
            for row in rows:
                array.InsertNextTuple(row)
        array.SetName(name.capitalize())
        data.GetFieldData().AddArray(array)
    return data


def source_of(data):
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    return source


def run(make, *inputs, **properties):
    """The errors of a filter of these inputs, and how many points it has."""
    proxy = make(*map(source_of, inputs))
    for name, value in properties.items():
        proxy.SetPropertyWithName(name, value)
    proxy.UpdateVTKObjects()
    said = []

    def heard(_caller, _event, text):
        said.append(text)

    heard.CallDataType = "string0"
    algorithm = proxy.GetClientSideObject()
    algorithm.AddObserver("ErrorEvent", heard)
    proxy.UpdatePipeline()
    points = algorithm.GetOutputDataObject(0).GetNumberOfPoints()
    simple.Delete(proxy)
    return {"said": "".join(said), "points": points}
