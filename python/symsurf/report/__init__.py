"""Reports: HTML pages that need nothing but a browser, with the shape in 3D."""

from .cohort import cohort_page
from .files import report_tasks, write_report
from .page import shape_page
from .scene import require_viewer

__all__ = ["cohort_page", "report_tasks", "require_viewer", "shape_page", "write_report"]
