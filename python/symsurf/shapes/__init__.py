"""Point sets and meshes, and what chooses the points of masks and images."""

from .shape import Shape
from .thresholds import Choice, chosen_by

__all__ = ["Choice", "Shape", "chosen_by"]
