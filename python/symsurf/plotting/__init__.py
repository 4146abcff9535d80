"""Pictures of results, with PyVista."""

from . import analysis_plotting, operation_plotting  # noqa: F401  # for ``plot`` of their results
from .drawing import INK, SIZE, new_plotter, write_picture
from .result_plotting import draw, plot

__all__ = ["INK", "SIZE", "draw", "new_plotter", "plot", "write_picture"]
