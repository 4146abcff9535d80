"""Damage to points."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .. import _core
from ..shapes.poly_data import points_of
from .algorithm import Algorithm, Property, selected
from .arrays import drop_normals, set_subset

_OWN = {"seed": Property(0, "The same seed gives the same damage on every machine.")}


class PointDamage(Algorithm):
    """Damages a shape: noise, holes, rotation, uneven density; ``vtkPointDamage`` in
    Python.

    The output is the input with its points moved or some of them left out, together with the cells
    that need those. Normals are not passed on.
    """

    _properties = selected("damage", "What is done to the points.", _core.damages(), _OWN)

    def _run(self, inputs: list[Any], outputs: list[vtkPolyData]) -> None:
        (shape,) = inputs
        points, kept = _core.damage(
            self._options["damage"],
            points_of(shape),
            self._chosen("damage", _core.damages()),
            self._options["seed"],
        )
        set_subset(outputs[0], shape, points, np.asarray(kept, np.int64))
        drop_normals(outputs[0])
