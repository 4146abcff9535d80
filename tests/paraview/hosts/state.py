"""Saves a state, starts anew from it, and tells the mirror's field data before and after."""

import os
import sys

from paraview import simple
from session import answer, fetched, field, lopsided

state = os.path.join(sys.argv[2], "mirror.pvsm")
detection = simple.MirrorDetection(Input=lopsided(simple.Sphere()), Method="plane")
detection.PlanePairDistance = 0.125
simple.RenameSource("The mirror", detection)
before = field(fetched(detection, 1))
simple.SaveState(state)
simple.ResetSession()
simple.LoadPlugin(os.environ["SYMSURF_PLUGIN"], remote=False, ns=vars(simple))
simple.LoadState(state)
again = simple.FindSource("The mirror")
assert again.PlanePairDistance == 0.125 and again.Method == "plane"
answer([before, field(fetched(again, 1))])
