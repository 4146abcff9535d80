"""Sets properties of a new proxy and tells what the VTK object's getters said before and after.

Arguments: the answer file, the proxy's name, {property: value} as JSON.
"""

import json
import sys

from paraview import simple
from session import answer
from symsurf_filters import vtkSymsurfFilters  # noqa: F401  (the objects' own classes)

simple.Sphere()  # the filters' input
proxy = getattr(simple, sys.argv[2])()
vtk_object = proxy.GetClientSideObject()
values = json.loads(sys.argv[3])


def got():
    return {name: getattr(vtk_object, "Get" + name)() for name in values}


before = got()
for name, value in values.items():
    proxy.SetPropertyWithName(name, value)
proxy.UpdateVTKObjects()
answer({"before": before, "after": got()})
