"""The second of the processes has no points, none that is finite or a shape that none can use; or
nobody has any points.

What each process found and said in each case. Arguments: the answer file, the points as NumPy's.
"""

import json
import sys
from pathlib import Path

import numpy as np
from paraview import simple
from session import answer, field, is_client
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkTable
from vtkmodules.vtkParallelCore import vtkMultiProcessController

controller = vtkMultiProcessController.GetGlobalController()
rank, size = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
whole = np.load(sys.argv[2])
nothing, unknown = np.empty((0, 3)), np.full((50, 3), np.nan)
others = np.array_split(whole, size - 1)[rank - (rank > 1)] if rank != 1 else None
cases = {
    "no points": nothing if rank == 1 else others,
    "no finite point": unknown if rank == 1 else others,
    "no shape": "a table" if rank == 1 else others,
    "nobody has points": nothing,
    "nobody has a finite point": unknown,
}


def data_of(rows):
    if isinstance(rows, str):
        return vtkTable()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(rows), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    return data


def run(method, rows):
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data_of(rows))
    detection = simple.MirrorDetection(Input=source, Method=method)
    algorithm = detection.GetClientSideObject()
    said = {"ErrorEvent": [], "WarningEvent": []}

    def heard(_caller, event, text):
        said[event].append(text)

    heard.CallDataType = "string0"
    for event in said:
        algorithm.AddObserver(event, heard)
    detection.UpdatePipeline()
    surface_points = algorithm.GetOutputDataObject(2).GetNumberOfPoints()
    fields = field(algorithm.GetOutputDataObject(1))
    return said | {"score": fields.get("Score"), "pairs": surface_points}


own = [
    (method, name, run(method, rows))
    for method in ("plane", "sphere")
    for name, rows in cases.items()
]
with open(f"{sys.argv[1]}.{rank}", "w") as file:
    json.dump(own, file)
controller.Barrier()
if is_client():
    answer([json.loads(Path(f"{sys.argv[1]}.{other}").read_text()) for other in range(size)])
