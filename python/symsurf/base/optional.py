"""The packages that symsurf does without, each with the extra that brings it."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

_EXTRAS = {
    "pyvista": ("PyVista", "plot"),
    "trame_vtk": ("trame-vtk", "report"),
    "vtkmodules": ("VTK", "vtk"),
}


def require(what: str, *packages: str) -> ModuleType:
    """The last of the packages, imported.

    Raises ModuleNotFoundError, in a sentence that begins with ``what`` (in the plural), where one
    is not installed. Another reason why it cannot be imported is raised as it is.
    """
    try:
        return [import_module(package) for package in packages][-1]
    except ModuleNotFoundError as error:
        if error.name not in packages:  # a package that is there misses one of its own
            raise
        names = " and ".join(_EXTRAS[package][0] for package in packages)
        extra = _EXTRAS[packages[-1]][1]
        raise ModuleNotFoundError(
            f"{what} need {names}: pip install 'symsurf[{extra}]'", name=error.name
        ) from None
