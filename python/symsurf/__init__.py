"""Finds the mirror of a 3D point set: a plane, a sphere or a curved surface.

>>> import symsurf
>>> result = symsurf.detect("scan.ply")
>>> result.mirror, result.score, result.verdict
"""

from . import detectors, metrics, mirror_operations, synthetic
from ._core import (
    Cancelled,
    Cylinder,
    FreeForm,
    HeightField,
    InvalidInput,
    InvalidParameter,
    Method,
    Mirror,
    Operation,
    Parameter,
    Plane,
    Quadric,
    Sphere,
    SurfaceMirror,
    __version__,
    bend,
    make_mirror,
    methods,
    operations,
    straight_mirror,
)
from .batching import batch
from .detection import detect, match
from .detectors import *  # detect_<method>, one for each in methods()
from .inputs import InputWarning
from .mirror_operations import *  # one for each in operations(), and what it gives
from .result import Result
from .sampling import downsample, estimate_normals
from .shape import Shape, read

__all__ = [
    "Cancelled",
    "Cylinder",
    "FreeForm",
    "HeightField",
    "InputWarning",
    "InvalidInput",
    "InvalidParameter",
    "Method",
    "Mirror",
    "Operation",
    "Parameter",
    "Plane",
    "Quadric",
    "Result",
    "Shape",
    "Sphere",
    "SurfaceMirror",
    "__version__",
    "batch",
    "bend",
    "detect",
    "downsample",
    "estimate_normals",
    "make_mirror",
    "match",
    "methods",
    "metrics",
    "operations",
    "read",
    "straight_mirror",
    "synthetic",
]
__all__ += detectors.__all__ + mirror_operations.__all__
