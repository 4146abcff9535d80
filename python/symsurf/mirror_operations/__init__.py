"""What is done with a mirror: one function for each of ``operations()``.

>>> asymmetry = symsurf.asymmetry("skull.ply")
>>> asymmetry.statistics["rms"], asymmetry.distance.max()
"""

from . import functions
from .functions import *  # one for each in operations()

__all__ = functions.__all__
