"""Running an analysis of the core on what Python users have."""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from ..base.lengths import as_fractions, diagonal_of
from ..detection import Progress
from ..reading.inputs import as_input, refuses, warn
from ..results.analysis_results import RESULTS, AnalysisResult
from ..shapes import Shape


def analyse(
    name: str,
    shape: object,
    *,
    faces: ArrayLike | None = None,
    nonfinite: str = "skip",
    absolute: bool = False,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> AnalysisResult:
    """Runs one of ``analyses()``; arguments and errors are those of the function of that name."""
    given = as_input(shape, faces)
    if absolute:
        described = _core.analyses()[name].parameters
        parameters = as_fractions(parameters, described, lambda: diagonal_of(given.points))
    made = _core.analyse(
        name, given.points, given.faces, refuses(nonfinite), threads, progress, parameters
    )
    warn(made["statistics"])
    return RESULTS[name].from_fields(Shape(made["points"], given.faces, space=given.space), made)
