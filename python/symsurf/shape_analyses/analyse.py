"""Running an analysis of the core on what Python users have."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import InvalidInput, InvalidParameter
from ..base.lengths import as_fractions, diagonal_of
from ..base.options import Reading, part
from ..base.progress import Progress
from ..reading.inputs import Input, as_input, refuses, warn
from ..results.analysis_results import RESULTS, AnalysisResult


def analyse(
    name: str,
    shape: object,
    other: object = None,
    *,
    faces: ArrayLike | None = None,
    colours: ArrayLike | None = None,
    nonfinite: str = "skip",
    threshold: float | None = None,
    label: int | str | None = None,
    scalars: str | None = None,
    external_files: bool = False,
    absolute: bool = False,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> AnalysisResult:
    """Runs one of ``analyses()``; arguments and errors are those of the function of that name."""
    reading = Reading(**part(Reading, locals()))
    given = as_input(shape, faces, reading)
    if absolute:
        described = _core.analyses()[name].parameters
        parameters = as_fractions(parameters, described, lambda: diagonal_of(given.points))
    counted = _colours(given.colours if colours is None else colours, parameters.get("texture"))
    if colours is not None and counted is None:
        if not _core.analyses()[name].takes_colours:
            raise TypeError(f"{name}() got an unexpected keyword argument 'colours'")
        raise InvalidParameter("colours are given, but texture is not; allowed is texture=True")
    second = Input(None, None) if other is None else as_input(other, None, reading)
    made = _core.analyse(
        name,
        given.points,
        given.faces,
        refuses(nonfinite),
        counted,
        threads,
        progress,
        parameters,
        second.points,
        second.faces,
    )
    warn(made["statistics"])
    found = given.as_shape(made["points"], colours=counted)
    return RESULTS[name].from_fields(found, made)


def _colours(given: object, count: object) -> NDArray[np.float64] | None:
    """Rows of channels, where they count; a single channel may be given as (n,)."""
    if given is None or not count:
        return None
    try:
        colours = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"colours are no numbers ({error}); allowed is (n, k)") from error
    if colours.ndim == 1:
        colours = colours[:, None]
    if colours.ndim != 2 or not colours.size:
        raise InvalidInput(
            f"colours have shape {colours.shape}; allowed is (n, k), one row per point"
        )
    return colours
