"""Finds the mirror of a 3D point set: a plane, a sphere or a curved surface.

>>> import symsurf
>>> shape = symsurf.read("scan.ply")
>>> result = symsurf.detect(shape.points)
>>> result.mirror, result.score
"""

from . import detectors, metrics, synthetic
from ._core import (
    Cancelled,
    FreeForm,
    HeightField,
    InvalidInput,
    InvalidParameter,
    Method,
    Mirror,
    Parameter,
    Plane,
    Sphere,
    SurfaceMirror,
    __version__,
    make_mirror,
    methods,
)
from .detection import detect, match
from .detectors import *  # noqa: F403 (detect_<method>, one for each in methods())
from .result import Result
from .sampling import downsample, estimate_normals
from .shape import Shape, read

__all__ = [
    "Cancelled",
    "FreeForm",
    "HeightField",
    "InvalidInput",
    "InvalidParameter",
    "Method",
    "Mirror",
    "Parameter",
    "Plane",
    "Result",
    "Shape",
    "Sphere",
    "SurfaceMirror",
    "__version__",
    "detect",
    "downsample",
    "estimate_normals",
    "make_mirror",
    "match",
    "methods",
    "metrics",
    "read",
    "synthetic",
]
__all__ += detectors.__all__
