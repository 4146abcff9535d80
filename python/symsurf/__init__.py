"""Finds the mirror of a 3D point set: a plane, a sphere or a curved surface.

>>> import symsurf
>>> result = symsurf.detect("scan.ply")
>>> result.mirror, result.score, result.verdict
"""

from typing import TYPE_CHECKING

from . import detectors, metrics, synthetic
from ._core import (
    Analysis,
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
    ReflectionPoints,
    Sphere,
    SurfaceMirror,
    __version__,
    analyses,
    make_mirror,
    methods,
    operations,
)
from .bending import bend, straight_mirror
from .detection import detect, match
from .detectors import *  # detect_<method>, one for each in methods()
from .inputs import InputWarning
from .mirror_operations import (
    Alignment,
    Asymmetry,
    Completed,
    Correspondences,
    OperationResult,
    Straightened,
    Symmetrized,
    functions,
)
from .mirror_operations.functions import *  # one for each in operations()
from .reading import read
from .result import Result
from .sampling import downsample, estimate_normals
from .shape import Shape
from .shape_analyses import (
    AnalysisResult,
    Axis,
    IntrinsicSymmetry,
    PartialSymmetries,
    RecurringParts,
    Symmetries,
    SymmetryEmbedding,
    Transformation,
)
from .shape_analyses import functions as analysing_functions
from .shape_analyses.functions import *  # one for each in analyses()

if TYPE_CHECKING:
    from .batching import batch

__all__ = [
    "Alignment",
    "Analysis",
    "AnalysisResult",
    "Asymmetry",
    "Axis",
    "Cancelled",
    "Completed",
    "Correspondences",
    "Cylinder",
    "FreeForm",
    "HeightField",
    "InputWarning",
    "IntrinsicSymmetry",
    "InvalidInput",
    "InvalidParameter",
    "Method",
    "Mirror",
    "Operation",
    "OperationResult",
    "Parameter",
    "PartialSymmetries",
    "Plane",
    "Quadric",
    "RecurringParts",
    "ReflectionPoints",
    "Result",
    "Shape",
    "Sphere",
    "Straightened",
    "SurfaceMirror",
    "Symmetries",
    "Symmetrized",
    "SymmetryEmbedding",
    "Transformation",
    "__version__",
    "analyses",
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
__all__ += detectors.__all__
__all__ += functions.__all__
__all__ += analysing_functions.__all__

if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        # `import symsurf` does not wait for what works on many files.
        if name == "batch":
            from .batching import batch

            return batch
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})
