"""The operations as functions, made from their own descriptions."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from typing import Any, cast

from .._core import Operation, operations, require_found_parameter
from ..base.descriptions import argument_text, keyword, name_function, parameter_texts, renamed
from ..base.options import Reading, Search, documentation
from ..results.operation_results import RESULTS, OperationResult, Transferred
from .operate import operate, with_values

_ARGUMENTS = inspect.signature(operate).parameters

_VALUES = (
    "values: (n,) or (n, k) attributes of the points, or a dictionary of such arrays; None: pass "
    "them to ``carried`` of the result later."
)

_DOCUMENTED = {
    "shape": "points, a mesh or a file, as for ``detect``; points that are not finite do not move and "
    'have no counterpart: ``statistics["nonfinite_points"]`` is their number.',
    "mirror": "a result of ``detect``, a mirror of any kind, or a plane across an axis such as "
    '"x=0" or "y=-1.5", in the unit and pose of the points; None: the mirror is found first.',
    "other": "the second of two shapes of a pair, in a pose of its own, in place of a mirror: "
    "``match_pair`` lays its reflection on ``shape``, which is compared with it. Arrays have the rows of "
    "``shape``, counterparts the indices of ``other``; both are meshes, or both clouds.",
    "mask": "(n,) in [0, 1], or booleans: how far each point may move.",
    "pairs": 'landmarks that mirror each other, with ``pairing="homologous"``: (k, 2) indices of '
    "points, or (k, 2, 3) places in input units. Without effect where both sides have one "
    "triangulation.",
    "pairs_sd": "standard deviation of placing each landmark, input units: a number, or (k,).",
    "faces": "(m, 3) indices of points, if ``shape`` has none of its own.",
    "kinds": 'what arrays of the points are, by name, for ``carried``, ``like`` and ``save``: "scalar", '
    '"label", "weight", "position", "vector", "normal", "tensor", "quaternion" or "harmonics", such as '
    '``dict(wind="vector")``; None: what the object or the file says of them.',
    "bands": "limits of the distance, above 0 and in input units: ``bands`` of the result has the area "
    "within each, ``patches`` the connected regions above the smallest.",
    "repeat": "number of random halves of the points in which the mirror is found again, as for ``detect``: "
    '``statistics`` also has "rms_sd" of the asymmetry, input units. Needs a mirror that is found, or the '
    "result of its detection.",
    "absolute": "True: lengths are given in input units, not as fractions of the diagonal of the "
    "bounding box; ``parameters`` of the result has fractions.",
    "require_found": f"{require_found_parameter().doc} A given result is refused likewise.",
    **{name: f"{text}." for name, text in documentation(Search).items()},
    **{name: f"{text}." for name, text in documentation(Reading).items()},
    "threads, progress": "as for ``detect``.",
}

_OR_AXIS = " Or an ``Axis``. Both may also be passed as ``symmetry``."

_ERRORS = """
Raises:
    InvalidInput: no mirror is found, or, with ``require_found``, one with the verdict "none"; less
        than half of the points have an image; {mask}otherwise as ``detect``.
    InvalidParameter, Cancelled: as ``detect``."""


def _takes_axis(operation: Operation) -> bool:
    return any(parameter.name == "symmetry" for parameter in operation.parameters)


def takes_pairs(operation: Operation) -> bool:
    """Whether landmarks may be given: ``pairs`` and ``pairs_sd``."""
    return any(parameter.name == "pairing" for parameter in operation.parameters)


def _lacking(operation: Operation) -> list[str]:
    """The arguments that the operation does not take."""
    return [
        *([] if operation.takes_other else ["other"]),
        *([] if operation.takes_mask else ["mask"]),
        *([] if takes_pairs(operation) else ["pairs", "pairs_sd"]),
        *([] if operation.name == "asymmetry" else ["bands", "repeat"]),
    ]


def _signature(operation: Operation) -> inspect.Signature:
    shared = {name: word for name, word in _ARGUMENTS.items() if name not in ("name", "parameters")}
    for name in _lacking(operation):
        del shared[name]
    own = {parameter.name: keyword(parameter) for parameter in operation.parameters}
    if _takes_axis(operation):
        own["symmetry"] = own["symmetry"].replace(
            annotation=f"{own['symmetry'].annotation} | Mirror | Result | Axis"
        )
    else:
        shared["mirror"] = shared["mirror"].replace(annotation="Result | Mirror | str | None")
    words = {name: shared.pop(name) for name in ("shape", "mirror")} | own | shared
    if operation.carries_values:
        values = inspect.Parameter(
            "values", inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation="ArrayLike | dict | None"
        )
        words = {"values": values} | words
    returned = RESULTS[operation.name].__name__
    return inspect.Signature(list(words.values()), return_annotation=returned)


def _documentation(operation: Operation) -> list[str]:
    texts = dict(_DOCUMENTED)
    if _takes_axis(operation):
        texts["mirror"] += _OR_AXIS
    for name in _lacking(operation):
        del texts[name]
    shared = [argument_text(f"{name}: {text}") for name, text in texts.items()]
    mask = "a mask that is not one number in [0, 1] per point;\n        "
    return [
        textwrap.fill(operation.summary, 96),
        "",
        "Args:",
        *([argument_text(_VALUES)] if operation.carries_values else []),
        *shared[:2],
        *parameter_texts(operation.parameters),
        *shared[2:],
        *_ERRORS.format(mask=mask if operation.takes_mask else "").splitlines(),
    ]


def _function(operation: Operation) -> Callable[..., OperationResult]:
    @renamed(result="mirror")
    def function(shape: Any, mirror: Any = None, **options: Any) -> OperationResult:
        return operate(operation.name, shape, mirror, **options)

    @renamed(result="mirror")
    def carry(values: Any, shape: Any, mirror: Any = None, **options: Any) -> OperationResult:
        made = operate(operation.name, shape, mirror, **options)
        return with_values(cast(Transferred, made), values)

    return name_function(
        carry if operation.carries_values else function,
        operation.name,
        __name__,
        _signature(operation),
        _documentation(operation),
    )


__all__ = list(operations())
globals().update({name: _function(operation) for name, operation in operations().items()})
