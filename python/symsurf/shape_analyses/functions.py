"""The analyses as functions, made from their own descriptions."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from typing import Any

from .._core import Analysis, InvalidParameter, analyses
from ..base.descriptions import argument_text, keyword, name_function, parameter_texts
from ..base.options import Reading, Search, documentation, part
from ..reading.splitting import parts_of
from ..results.analysis_results import RESULTS, AnalysisResult
from .analyse import analyse

_PAIR = ("left", "right")
_ARGUMENTS = inspect.signature(analyse).parameters

_COLOURS = (
    "(n, k) of the points, one channel per column, for ``texture``; without them those that ``shape`` "
    "brings: a Shape, a file (PLY, OBJ, OFF, columns, VTK's), a mesh of PyVista, trimesh or Open3D."
)
_PARTS = inspect.Parameter(
    "parts",
    inspect.Parameter.KEYWORD_ONLY,
    default=None,
    annotation="str | ArrayLike | None",
)
_DOCUMENTED = {
    "parts": "analyse each part of a scene by itself, and return a list of results; as for ``detect``.",
    "faces": "(m, 3) indices of points, if ``shape`` has none of its own.",
    "colours": _COLOURS,
    "nonfinite": f"{documentation(Search)['nonfinite']}.",
    **{name: f"{text}." for name, text in documentation(Reading).items()},
    "absolute": "True: lengths are in input units, in place of fractions of the diagonal of the "
    "bounding box; ``parameters`` of what is given back has them as fractions.",
    "threads, progress": "as for ``detect``.",
}


def _left_out(analysis: Analysis) -> set[str]:
    """What ``analyse`` takes, and the function of the analysis does not."""
    return {
        "name",
        "parameters",
        *([] if analysis.takes_colours else ["colours"]),
        *(["faces", "parts"] if analysis.takes_other else ["other"]),
    }


def _signature(analysis: Analysis) -> inspect.Signature:
    shared = {name: word for name, word in _ARGUMENTS.items() if name not in _left_out(analysis)}
    own = {parameter.name: keyword(parameter) for parameter in analysis.parameters}
    shape = shared.pop("shape")
    shared.pop("other", None)
    names = _PAIR if analysis.takes_other else ("shape",)
    parts = {} if analysis.takes_other else {"parts": _PARTS}
    words = {name: shape.replace(name=name) for name in names} | own | parts | shared
    returned = RESULTS[analysis.name].__name__
    return inspect.Signature(list(words.values()), return_annotation=returned)


def _documentation(analysis: Analysis) -> list[str]:
    return [
        textwrap.fill(analysis.summary, 96),
        "",
        "Args:",
        argument_text(
            f"{', '.join(_PAIR) if analysis.takes_other else 'shape'}: points, a mesh or a file, as "
            "``detect`` takes them."
        ),
        *parameter_texts(analysis.parameters),
        *(
            argument_text(f"{name}: {text}")
            for name, text in _DOCUMENTED.items()
            if name not in _left_out(analysis)
        ),
        "",
        "Raises:",
        "    InvalidInput, InvalidParameter, Cancelled: as ``detect`` does.",
        "",
        "A shape without any symmetry is no error.",
    ]


def _function(analysis: Analysis) -> Callable[..., AnalysisResult]:
    def function(
        shape: Any, *, parts: Any = None, **options: Any
    ) -> AnalysisResult | list[AnalysisResult]:
        if parts is None:
            return analyse(analysis.name, shape, **options)
        if options.get("colours") is not None:
            raise InvalidParameter(
                "colours are given beside parts; allowed is a Shape that has them"
            )
        reading = Reading(**part(Reading, options))
        faces = options.pop("faces", None)
        own = {name: value for name, value in options.items() if name not in part(Reading, reading)}
        scene = parts_of(shape, parts, faces, reading)
        return [analyse(analysis.name, each, **own) for each in scene]

    def of_two(left: Any, right: Any, **options: Any) -> AnalysisResult:
        return analyse(analysis.name, left, right, **options)

    return name_function(
        of_two if analysis.takes_other else function,
        analysis.name,
        __name__,
        _signature(analysis),
        _documentation(analysis),
    )


__all__ = list(analyses())
globals().update({name: _function(analysis) for name, analysis in analyses().items()})
