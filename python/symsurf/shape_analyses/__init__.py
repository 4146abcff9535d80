"""Symmetries of a shape other than one mirror: one function for each of ``analyses()``.

>>> found = symsurf.symmetries("part.ply")
>>> found.group, found.planes, found.axes
"""

from . import functions
from .functions import *  # one for each in analyses()

__all__ = functions.__all__
