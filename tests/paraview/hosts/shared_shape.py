"""Points shared out over the processes in one of several ways; tells the mirror and the partners.

Arguments: the answer file, how ("interleaved", "slabs", "first_only"), a server's port or nothing.
"""

import os
import sys

from paraview import servermanager, simple

if len(sys.argv) > 3:
    simple.Connect("localhost", int(sys.argv[3]))
    simple.LoadPlugin(os.environ["SYMSURF_PLUGIN"], remote=True, ns=vars(simple))

from session import answer, fetched, field, is_client, point_array

SHARE = """
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkParallelCore import vtkMultiProcessController

controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId() if controller else 0
size = controller.GetNumberOfProcesses() if controller else 1
random = np.random.default_rng(5)
x = random.normal(size=(6000, 3))
x /= np.linalg.norm(x, axis=1)[:, None]
x *= (1 + 0.3 * np.sin(3 * x[:, 0] + x[:, 1]) + 0.2 * x[:, 1] * x[:, 2])[:, None]
normal = np.array([2.0, -1.0, 0.5]) / np.linalg.norm([2.0, -1.0, 0.5])
x = np.vstack([x, x - 2 * ((x @ normal) - 0.4)[:, None] * normal])
x = random.permutation(x)
owner = {
    "interleaved": np.arange(len(x)) % size,
    "slabs": np.searchsorted(np.quantile(x[:, 2], np.arange(1, size) / size), x[:, 2]),
    "first_only": np.zeros(len(x), int),
}[how]
mine = np.flatnonzero(owner == rank)

output = self.GetPolyDataOutput()
points = vtkPoints()
points.SetData(numpy_to_vtk(np.ascontiguousarray(x[mine]), deep=True))
output.SetPoints(points)
ids = numpy_to_vtk(mine.astype(np.int64), deep=True)
ids.SetName("Id")
output.GetPointData().AddArray(ids)
output.AllocateEstimate(len(mine), 1)
for i in range(len(mine)):
    cell = vtkIdList()
    cell.InsertNextId(i)
    output.InsertNextCell(1, cell)
"""

shape = simple.ProgrammableSource(Script=f"how = {sys.argv[2]!r}\n{SHARE}")
detection = simple.MirrorDetection(Input=shape, Method="plane")
mapped, mirror, surface = (fetched(detection, port) for port in range(3))
first_mirror = servermanager.Fetch(detection, 0, idx=1)
ids, partners = point_array(mapped, "Id"), point_array(mapped, "MirrorPartner")
order = ids.argsort()
if is_client():  # the others see their own part only
    answer(
        {
            "field": field(first_mirror),
            "bounds": mirror.GetBounds(),
            "partners": [int(ids[p]) if p >= 0 else -1 for p in partners[order]],
            "residuals": point_array(mapped, "MirrorResidual")[order].tolist(),
            "sides": point_array(mapped, "MirrorSide")[order].tolist(),
            "surface_points": surface.GetNumberOfPoints(),
        }
    )
