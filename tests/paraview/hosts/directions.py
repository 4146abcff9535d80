"""What the filters make of active vectors, normals and tensors.

Arguments: the answer file, a folder with shape.npz and mirrors.json and for the arrays, the proxies'
names.
"""

import json
import os
import sys

import numpy as np
from paraview import servermanager, simple
from session import answer
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

folder = sys.argv[2]
given = np.load(os.path.join(folder, "shape.npz"))


def poly_data(points, faces=None):
    made, coordinates = vtkPolyData(), vtkPoints()
    coordinates.SetData(numpy_to_vtk(points, deep=True))
    made.SetPoints(coordinates)
    if faces is not None:
        cells = vtkCellArray()
        cells.SetData(3, numpy_to_vtkIdTypeArray(faces.ravel(), deep=True))
        made.SetPolys(cells)
    return made


def source(data):
    made = simple.TrivialProducer()
    made.GetClientSideObject().SetOutput(data)
    made.MarkModified(made)
    return made


shape = poly_data(given["points"], given["faces"])
for name in ("Vectors", "Normals", "Tensors"):
    array = numpy_to_vtk(given[name], deep=True)
    array.SetName(name)
    getattr(shape.GetPointData(), "Set" + name)(array)
wind = numpy_to_vtk(given["Vectors"], deep=True)
wind.SetName("wind")
shape.GetPointData().AddArray(wind)


def mirror_data(kind, numbers):
    data = poly_data(np.zeros((1, 3)))
    text = vtkStringArray()
    text.SetName("Kind")
    text.InsertNextValue(kind)
    data.GetFieldData().AddArray(text)
    for name, value in numbers.items():
        camel = "".join(word.capitalize() for word in name.split("_"))
        rows = np.atleast_2d(np.array(value, dtype=float))
        array = numpy_to_vtk(np.ascontiguousarray(rows), deep=True)
        array.SetName(camel)
        data.GetFieldData().AddArray(array)
    return data


with open(os.path.join(folder, "mirrors.json")) as file:
    mirrors = json.load(file)
for name, (kind, numbers) in mirrors.items():
    mirror = source(mirror_data(kind, numbers))
    for proxy in sys.argv[3:]:
        word, _, options = proxy.partition(":")
        made = getattr(simple, word)(Input=source(shape), Mirror=mirror)
        for option in filter(None, options.split(",")):
            key, value = option.split("=")
            setattr(made, key, int(value) if value.isdigit() else value)
        if "Kinds" in made.ListProperties():
            made.Kinds = "wind=vector"
        made.UpdatePipeline()
        data = servermanager.Fetch(made, idx=0)
        arrays = {
            each: vtk_to_numpy(array)
            for each in ("Vectors", "Normals", "Tensors")
            if (array := getattr(data.GetPointData(), "Get" + each)()) is not None
        }
        if "Kinds" in made.ListProperties() and "Vectors" in arrays:
            np.testing.assert_array_equal(
                vtk_to_numpy(data.GetPointData().GetArray("wind")), arrays["Vectors"]
            )
        np.savez(
            os.path.join(folder, f"{name}-{word}"),
            points=vtk_to_numpy(data.GetPoints().GetData()),
            **arrays,
        )
answer(sorted(mirrors))
