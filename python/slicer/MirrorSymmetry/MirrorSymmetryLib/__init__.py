"""What the module does, without Qt: it runs in ``slicer-core`` as in Slicer."""

from .logic import Outputs, SymmetryLogic

__all__ = ["Outputs", "SymmetryLogic"]
