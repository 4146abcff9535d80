"""``detect_<method>`` for every method there is, made from the methods' own descriptions."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from typing import Any

from .._core import Method, methods
from ..base.descriptions import keyword, name_function, parameter_texts, renamed
from ..results import Result
from . import detect

# What every detector takes beside its method's parameters.
_OPTIONS = {
    name: parameter
    for name, parameter in inspect.signature(detect).parameters.items()
    if parameter.kind is inspect.Parameter.KEYWORD_ONLY
}

# The class of the mirrors that a method finds, where that is always the same.
_MIRRORS = {
    "plane": "Plane",
    "oblique_plane": "ObliquePlane",
    "sphere": "Sphere",
    "cylinder": "Cylinder",
    "quadric": "Quadric",
    "fixed_direction": "HeightField",
    "perpendicular": "FreeForm",
    "sphere_thesis": "Sphere",
    "plane_icp": "Plane",
    "plane_svd": "Plane",
    "plane_hruda": "Plane",
}


def _signature(method: Method) -> inspect.Signature:
    shape = inspect.signature(detect).parameters["shape"]
    own = [keyword(parameter) for parameter in method.parameters]
    found = f"Result[{_MIRRORS.get(method.name, 'Mirror')}]"
    return inspect.Signature([shape, *own, *_OPTIONS.values()], return_annotation=found)


def _documentation(method: Method) -> list[str]:
    least = f"at least {method.minimum_points} finite points"
    return [
        textwrap.fill(method.summary, 96),
        "",
        "Args:",
        f"    shape: {least}, or a mesh, as ``detect`` takes them.",
        *parameter_texts(method.parameters),
        # A name list that breaks over a line is no entry to the documentation's reader.
        *(
            f"    {', '.join(names)}: as for ``detect``."
            for names in (list(_OPTIONS)[:6], list(_OPTIONS)[6:])
        ),
    ]


def _detector(method: Method) -> Callable[..., Result]:
    @renamed(points="shape")
    def detector(shape: Any, **options: Any) -> Result:
        return detect(shape, method.name, **options)

    return name_function(
        detector, f"detect_{method.name}", __name__, _signature(method), _documentation(method)
    )


__all__ = [f"detect_{name}" for name in methods()]
globals().update({f"detect_{method.name}": _detector(method) for method in methods().values()})
