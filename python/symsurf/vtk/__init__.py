"""The filters of symsurf for the ``vtk`` package that pip installs.

>>> from symsurf.vtk import MirrorDetection, MirrorAsymmetry
>>> detection = MirrorDetection(method="plane")
>>> detection.SetInputConnection(reader.GetOutputPort())
>>> asymmetry = MirrorAsymmetry(max_angle=45)
>>> asymmetry.SetInputConnection(reader.GetOutputPort())
>>> asymmetry.SetMirrorConnection(detection.GetOutputPort(detection.MIRROR))  # or none: it is found
>>> asymmetry.Update()
>>> asymmetry.output.GetPointData().GetArray("MirrorAsymmetrySigned")

Every parameter is a property, a keyword of the constructor, and has its setter and getter. Bad input
and values out of range are errors of the filter; they leave the outputs empty.

Programs built on VTK or ParaView have the same filters in C++: ``vtkMirrorDetection``.
"""

from ..base.optional import require as _require

_require("the filters of symsurf.vtk", "vtkmodules")

from . import operations as _operations
from .analysis import SymmetryAnalysis
from .damage import PointDamage
from .detection import MirrorDetection
from .operations import *  # a filter for each of operations(): MirrorAsymmetry, ...
from .operations import MirrorOperation
from .reflection import MirrorReflection
from .samples import MirrorSampleSource

__all__ = [
    "MirrorDetection",
    "MirrorOperation",
    "MirrorReflection",
    "MirrorSampleSource",
    "PointDamage",
    "SymmetryAnalysis",
]
__all__ += _operations.__all__
