"""The tables of bad input, and properties out of range, in one session: what each filter said, how
many points it left, and how many a good run after it finds.

Arguments: the answer file, [[property, method, value], ...] as JSON.
"""

import json
import sys
from pathlib import Path

from paraview import simple
from session import answer
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

sys.path.insert(0, str(Path(__file__).parents[2]))
from bad_input import tables

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


def detect(data, **properties):
    return run(lambda source: simple.MirrorDetection(Input=source), data, **properties)


def reflect(data, mirror):
    return run(lambda a, b: simple.MirrorReflection(Input=a, Mirror=b), data, mirror)


good = cloud_of(GOOD)
plane = mirror_of("plane", {"normal": (1.0, 0.0, 0.0), "offset": 0.0})
answers = {"clouds": [], "mirrors": [], "properties": []}


def case(kind, seen, again):
    answers[kind].append(seen | {"good": again["points"], "said of good": again["said"]})


for cloud in tables.clouds():
    seen = detect(cloud_of(cloud.points), Method="plane", RefuseNonfinite=cloud.refuses_nonfinite)
    case("clouds", seen, detect(good, Method="plane"))
for mirror in tables.mirrors():
    case("mirrors", reflect(good, mirror_of(mirror.kind, mirror.numbers)), reflect(good, plane))
for name, method, value in json.loads(sys.argv[2]):
    seen = detect(good, Method=method, **{name: float("nan") if value is None else value})
    case("properties", seen, detect(good, Method="plane"))
answer(answers)
