"""What several processes gain: seconds of vtkMirrorDetection and memory a process, as pvbatch runs it.

    mpiexec -n 2 pvbatch --symmetric tests/benchmarks/vtk/parallel.py [POINTS] [slabs | turns]

One thread a process. The points are shared out in slabs of space or by turns.
"""

import sys
import time

import numpy as np
from paraview import simple  # noqa: F401  (brings the controller)
from symsurf_filters import vtkSymsurfFilters
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkParallelCore import vtkMultiProcessController

size = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
how = sys.argv[2] if len(sys.argv) > 2 else "slabs"
controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId() if controller else 0
processes = controller.GetNumberOfProcesses() if controller else 1


def shape() -> np.ndarray:
    """A dented ball mirrored in x, turned."""
    rng = np.random.default_rng(1)
    u = rng.normal(size=(size // 2, 3))
    u /= np.linalg.norm(u, axis=1)[:, None]
    radius = 1 + 0.3 * np.sin(3 * u[:, 1] + 1) + 0.25 * np.cos(2 * u[:, 2] - 0.5) * u[:, 1]
    half = u * radius[:, None] * (1, 1.4, 0.8)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.vstack([half, half * (-1, 1, 1)]) @ turn


def memory(name: str) -> float:
    """Megabytes of this process: VmRSS now, VmHWM at the most."""
    with open("/proc/self/status") as status:
        (line,) = [line for line in status if line.startswith(name)]
    return int(line.split()[1]) / 1024


points = shape()
if how == "slabs":
    cuts = np.quantile(points[:, 2], np.arange(1, processes) / processes)
    owner = np.searchsorted(cuts, points[:, 2])
else:
    owner = np.arange(len(points)) % processes
own = np.ascontiguousarray(points[owner == rank])
del points, owner
vtk_points, data = vtkPoints(), vtkPolyData()
vtk_points.SetData(numpy_to_vtk(own))
data.SetPoints(vtk_points)

with open("/proc/self/clear_refs", "w") as peak:
    peak.write("5")  # VmHWM starts anew
before = memory("VmRSS")
taken = []
for _ in range(5):
    detection = vtkSymsurfFilters.vtkMirrorDetection()
    detection.SetInputData(data)
    detection.SetMethod("plane")
    detection.SetNumberOfThreads(1)
    if processes > 1:
        controller.Barrier()
    start, cpu = time.perf_counter(), time.process_time()
    detection.Update()
    if processes > 1:
        controller.Barrier()
    taken.append((time.perf_counter() - start, time.process_time() - cpu))
seconds, cpu = (min(column) for column in zip(*taken))
more = memory("VmHWM") - before
print(
    f"process {rank} of {processes}, {len(own)} of {size} points in {how}: {seconds:.3f} s "
    f"({cpu:.3f} s CPU), {more * 2**20 / len(own):.0f} bytes more a point of its own",
    flush=True,
)
