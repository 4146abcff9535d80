"""Reports: HTML pages that need nothing but a browser, with the shape in 3D."""

from .cohort import cohort_page
from .files import files_page
from .page import shape_page
from .scene import require_viewer

__all__ = ["cohort_page", "files_page", "require_viewer", "shape_page"]
