"""Symmetries of a shape other than one mirror: one function for each of ``analyses()``.

>>> found = symsurf.symmetries("part.ply")
>>> found.group, found.planes, found.axes
"""

from . import functions
from .elements import Axis, Transformation
from .functions import *  # one for each in analyses()
from .results import (
    AnalysisResult,
    IntrinsicSymmetry,
    PartialSymmetries,
    RecurringParts,
    Symmetries,
    SymmetryEmbedding,
)

__all__ = [
    "AnalysisResult",
    "Axis",
    "IntrinsicSymmetry",
    "PartialSymmetries",
    "RecurringParts",
    "Symmetries",
    "SymmetryEmbedding",
    "Transformation",
]
__all__ += functions.__all__
