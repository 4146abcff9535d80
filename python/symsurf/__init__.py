"""Finds the mirror of a 3D point set: a plane, a sphere or a curved surface.

>>> import symsurf
>>> result = symsurf.detect("scan.ply")
>>> result.mirror, result.score, result.verdict
"""

from typing import TYPE_CHECKING

from . import metrics, plotting, saving, synthetic  # noqa: F401  # results are drawn and saved by them
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
    ObliquePlane,
    Operation,
    Parameter,
    Plane,
    PointSummary,
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
from .base.input_warning import InputWarning
from .detection import detect, detectors, fit_mirror, match
from .detection.chunks import ChunkMatches, detect_chunks, match_chunks
from .detection.detectors import *  # detect_<method>, one for each in methods()
from .detection.sampling import downsample, estimate_normals
from .detection.summaries import summarize
from .mirror_operations import functions
from .mirror_operations.bending import bend, straight_mirror
from .mirror_operations.functions import *  # one for each in operations()
from .mirror_operations.measuring import repeatability
from .morphometrics import (
    AnovaRow,
    Cohort,
    LandmarkPairs,
    carry_landmarks,
    cohort,
    landmark_pairs,
    plane_of_landmarks,
)
from .reading import read
from .reading.landmarks import read_landmark_sets, read_landmarks
from .results import (
    Alignment,
    AnalysisResult,
    Asymmetry,
    Axis,
    Band,
    Completed,
    Correspondences,
    Half,
    HelicalSymmetry,
    Illuminated,
    IntrinsicSymmetry,
    OperationResult,
    PairMatch,
    PartialSymmetries,
    Patch,
    RecurringParts,
    Remeshed,
    Result,
    Straightened,
    Symmetries,
    Symmetrized,
    SymmetryAxis,
    SymmetryEmbedding,
    TolerancedGroup,
    Transferred,
    Transformation,
)
from .saving.matches import save_matches
from .shape_analyses import functions as analysing_functions
from .shape_analyses.functions import *  # one for each in analyses()
from .shapes import Landmarks, Shape

if TYPE_CHECKING:
    from .batching import batch

__all__ = [
    "Alignment",
    "Analysis",
    "AnalysisResult",
    "AnovaRow",
    "Asymmetry",
    "Axis",
    "Band",
    "Cancelled",
    "ChunkMatches",
    "Cohort",
    "Completed",
    "Correspondences",
    "Cylinder",
    "FreeForm",
    "Half",
    "HeightField",
    "HelicalSymmetry",
    "Illuminated",
    "InputWarning",
    "IntrinsicSymmetry",
    "InvalidInput",
    "InvalidParameter",
    "LandmarkPairs",
    "Landmarks",
    "Method",
    "Mirror",
    "ObliquePlane",
    "Operation",
    "OperationResult",
    "PairMatch",
    "Parameter",
    "PartialSymmetries",
    "Patch",
    "Plane",
    "PointSummary",
    "Quadric",
    "RecurringParts",
    "ReflectionPoints",
    "Remeshed",
    "Result",
    "Shape",
    "Sphere",
    "Straightened",
    "SurfaceMirror",
    "Symmetries",
    "Symmetrized",
    "SymmetryAxis",
    "SymmetryEmbedding",
    "TolerancedGroup",
    "Transferred",
    "Transformation",
    "__version__",
    "analyses",
    "batch",
    "bend",
    "carry_landmarks",
    "cohort",
    "detect",
    "detect_chunks",
    "downsample",
    "estimate_normals",
    "fit_mirror",
    "landmark_pairs",
    "make_mirror",
    "match",
    "match_chunks",
    "methods",
    "metrics",
    "operations",
    "plane_of_landmarks",
    "read",
    "read_landmark_sets",
    "read_landmarks",
    "repeatability",
    "save_matches",
    "straight_mirror",
    "summarize",
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
