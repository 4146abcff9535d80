"""Point sets, meshes and landmarks, and what chooses the points of masks and images."""

from .landmarks import Landmarks
from .shape import Shape
from .thresholds import chosen_by

__all__ = ["Landmarks", "Shape", "chosen_by"]
