"""VTK filters that find the mirror of a shape, in ``vtkSymsurfFilters``."""

# Its libraries, wherever it is installed, which the module is linked with.
from cvista import vtkFiltersGeometry as _geometry  # noqa: F401
from cvista import vtkParallelCore as _parallel  # noqa: F401
