"""The descriptions of the methods in words."""

from __future__ import annotations

from ._core import Parameter

_UNITS = {"diagonal": "of the diagonal"}


def allowed(parameter: Parameter) -> str:
    """What a parameter may be, with its unit: "[0, 1] of the diagonal"."""
    unit = _UNITS.get(parameter.unit, parameter.unit)
    return f"{parameter.range} {unit}".rstrip()
