"""Point sets, meshes and landmarks, and what chooses the points of masks and images."""

from .landmarks import Landmarks
from .shape import Shape
from .thresholds import Choice, chosen_by

__all__ = ["Choice", "Landmarks", "Shape", "chosen_by"]
