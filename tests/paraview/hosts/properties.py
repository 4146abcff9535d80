"""Sets properties of new proxies and tells what the VTK objects' getters said before and after.

Arguments: the answer file, {proxy's name: {property: value}} as JSON.
"""

import json
import sys

from paraview import simple
from session import answer
from symsurf_filters import vtkSymsurfFilters  # noqa: F401  (the objects' own classes)

simple.Sphere()  # the filters' input
seen = {}
for proxy_name, values in json.loads(sys.argv[2]).items():
    proxy = getattr(simple, proxy_name)()
    vtk_object = proxy.GetClientSideObject()

    def got(vtk_object=vtk_object, values=values):
        return {name: getattr(vtk_object, "Get" + name)() for name in values}

    before = got()
    for name, value in values.items():
        proxy.SetPropertyWithName(name, value)
    proxy.UpdateVTKObjects()
    seen[proxy_name] = {"before": before, "after": got()}
answer(seen)
