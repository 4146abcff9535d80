"""What is found and made, as data. The layers above register how it is saved and drawn."""

from .analysis_results import (
    AnalysisResult,
    HelicalSymmetry,
    IntrinsicSymmetry,
    PairMatch,
    PartialSymmetries,
    RecurringParts,
    Symmetries,
    SymmetryEmbedding,
)
from .elements import Axis, SymmetryAxis, TolerancedGroup, Transformation
from .given_mirror import found_mirror, mirror_of, plane_of
from .inspection import Band, Patch
from .operation_results import (
    Alignment,
    Asymmetry,
    Completed,
    Correspondences,
    Half,
    Illuminated,
    OperationResult,
    Remeshed,
    Straightened,
    Symmetrized,
    Transferred,
)
from .result import Result

__all__ = [
    "Alignment",
    "AnalysisResult",
    "Asymmetry",
    "Axis",
    "Band",
    "Completed",
    "Correspondences",
    "Half",
    "HelicalSymmetry",
    "Illuminated",
    "IntrinsicSymmetry",
    "OperationResult",
    "PairMatch",
    "PartialSymmetries",
    "Patch",
    "RecurringParts",
    "Remeshed",
    "Result",
    "Straightened",
    "Symmetries",
    "Symmetrized",
    "SymmetryAxis",
    "SymmetryEmbedding",
    "TolerancedGroup",
    "Transferred",
    "Transformation",
    "found_mirror",
    "mirror_of",
    "plane_of",
]
