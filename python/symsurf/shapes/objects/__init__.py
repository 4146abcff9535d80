"""Meshes, clouds and tables of other packages: what is taken of them, and others of their type.

A module a package, imported where such an object is, and with it the package, which is there then.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from types import ModuleType
from typing import Any

from ..._core import InvalidInput
from ..shape import Shape
from .parts import Parts, Remade

__all__ = [
    "Parts",
    "Remade",
    "grid_of",
    "is_known",
    "parts_of",
    "points_of",
    "remade",
    "remade_like",
]


def is_known(given: Any) -> bool:
    """Whether it is a Shape, or a mesh, a cloud or a table of a package that has its module here."""
    return isinstance(given, Shape) or _name_of(given) is not None


def parts_of(given: Any) -> Parts | None:
    """Points, faces and colours of an object of another package; None of what is none. Raises
    InvalidInput for one that does not say which numbers its points are, and for several in one."""
    if "pyvista.MultiBlock" in _names_of(type(given)):
        raise InvalidInput(
            f"the MultiBlock has {given.n_blocks} blocks; allowed is one of them, or all as one: "
            "blocks.combine().extract_surface()"
        )
    name = _name_of(given)
    return None if name is None else _module_of(name).parts_of(given)


def points_of(given: Any) -> Any:
    """The points of whatever has some; what has none is its points itself."""
    parts = parts_of(given)
    if parts is not None:
        return parts.points
    if isinstance(given, Shape) or not hasattr(given, "__array__"):
        for name in ("points", "vertices"):
            if hasattr(given, name):
                return getattr(given, name)
    return given


def grid_of(given: Any) -> Any:
    """The data set of PyVista whose points are those of a regular grid; None where it is none."""
    name = _name_of(given)
    if name not in ("pyvista.DataSet", "vtkmodules.vtkDataSet"):
        return None
    return _module_of(name).grid_of(given)


def remade(given: Any, made: Remade) -> Any:
    """An object of the same type with other points and its own attributes. Raises InvalidInput for
    what is none of another package."""
    name = _name_of(given)
    if name is None:
        raise InvalidInput(
            f"the object is of type {type(given).__name__}; allowed are {', '.join(_MODULES)}"
        )
    return _module_of(name).remade(given, made)


def remade_like(given: Any, count: int, made: Remade) -> Any:
    """The same of an object that must have as many points."""
    if grid_of(given) is not None:
        raise InvalidInput(
            f"the {type(given).__name__} is a regular grid, whose points do not move; allowed is a "
            "surface or a cloud"
        )
    points = len(points_of(given)) if _name_of(given) else count
    if points != count:
        raise InvalidInput(
            f"the {type(given).__name__} has {points} points; allowed is the one that was given, which "
            f"has {count}"
        )
    return remade(given, made)


# The classes, after the package that has them.
_MODULES = {
    "pyvista.DataSet": "pyvista",
    "trimesh.Trimesh": "trimesh",
    "trimesh.PointCloud": "trimesh",
    "trimesh.Scene": "trimesh",
    "open3d.PointCloud": "open3d",
    "open3d.TriangleMesh": "open3d",
    "itk.PointSet": "itk",
    "meshio.Mesh": "meshio",
    "pandas.DataFrame": "table",
    "polars.DataFrame": "table",
    "vtkmodules.vtkDataSet": "vtk",
}


def _name_of(given: Any) -> str | None:
    """Of subclasses that of the class that they are made from."""
    return next((name for name in _names_of(type(given)) if name in _MODULES), None)


def _names_of(kind: type) -> Iterator[str]:
    for each in kind.__mro__:
        name = each.__name__
        if name.startswith("itkPointSet"):  # a class for each type of number and dimension
            name = "PointSet"
        yield f"{each.__module__.partition('.')[0]}.{name}"


def _module_of(name: str) -> ModuleType:
    return import_module(f".{_MODULES[name]}_objects", __name__)
