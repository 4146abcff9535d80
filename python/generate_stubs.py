"""Writes the type stubs of what only exists at run time: the compiled module, and the functions
made from the descriptions of methods, operations and analyses.

Usage: generate_stubs.py BUILT STUBS. BUILT is the folder that holds the built package.
"""

from __future__ import annotations

import inspect
import sys
import textwrap
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType

import pybind11_stubgen


def compiled_stub() -> str:
    with TemporaryDirectory() as folder:
        variable = ["--ignore-unresolved-names", "T"]  # a mesh's own type, for Mirror.reflect
        pybind11_stubgen.main(["symsurf._core", "-o", folder, "--exit-code", *variable])
        stub = (Path(folder) / "symsurf" / "_core.pyi").read_text()
    head = '\nfrom symsurf.shapes import Shape\n\nT = typing.TypeVar("T")\n\n__all__'
    stub = stub.replace("\n__all__", head, 1)
    # A Shape is an array of its points, too.
    first = "    @typing.overload\n    def reflect(self, "
    return stub.replace(first, f"{first}mesh: Shape) -> Shape: ...\n{first}", 1)


def detectors_stub() -> str:
    from symsurf.detection import detectors

    return _functions_stub(
        detectors,
        "from numpy.typing import ArrayLike",
        "",
        "from .._core import Cylinder, FreeForm, HeightField, Mirror, ObliquePlane, Plane, Quadric, Sphere",
        "from ..results import Result",
        "from . import Progress",
    )


def operations_stub() -> str:
    from symsurf.mirror_operations import functions

    return _functions_stub(
        functions,
        "from numpy.typing import ArrayLike",
        "",
        "from .._core import Mirror",
        "from ..detection import Progress",
        "from ..results import *",
    )


def analyses_stub() -> str:
    from symsurf.shape_analyses import functions

    return _functions_stub(
        functions,
        "from numpy.typing import ArrayLike",
        "",
        "from ..detection import Progress",
        "from ..results import *",
    )


def _functions_stub(module: ModuleType, *imports: str) -> str:
    lines = [
        "from typing import Literal, overload",
        "",
        *imports,
        "",
        f"__all__ = {module.__all__}",
    ]
    for function in (getattr(module, name) for name in module.__all__):
        signature = inspect.signature(function)
        for each in _overloads(signature):
            lines += ["", *(["@overload"] if each is not signature else [])]
            lines += _declaration(function.__name__, each)
            lines += ["    ..."] if each is not signature else []
        if each is not signature:
            lines.pop()
        lines += textwrap.indent(f'"""{inspect.getdoc(function)}\n"""', "    ").splitlines()
    return "\n".join(lines) + "\n"


def _overloads(signature: inspect.Signature) -> list[inspect.Signature]:
    """With parts the functions return lists."""
    words = signature.parameters
    if "parts" not in words:
        return [signature]
    whole = words["parts"].replace(annotation="None")
    parts = words["parts"].replace(annotation="str | ArrayLike", default=inspect.Parameter.empty)
    lists = f"list[{signature.return_annotation}]"
    return [
        signature.replace(
            parameters=[*(words | {"parts": parts}).values()], return_annotation=lists
        ),
        signature.replace(parameters=[*(words | {"parts": whole}).values()]),
    ]


def _declaration(name: str, signature: inspect.Signature) -> list[str]:
    lines = [f"def {name}("]
    for word in signature.parameters.values():
        if word.kind is word.KEYWORD_ONLY and "    *," not in lines:
            lines.append("    *,")
        default = "" if word.default is word.empty else f" = {word.default!r}"
        lines.append(f"    {word.name}: {word.annotation}{default},")
    return [*lines, f") -> {signature.return_annotation}:"]


def main(built: str, stubs: str) -> None:
    sys.path[0] = built  # not the sources beside this script
    for name, stub in {
        "_core": compiled_stub(),
        "detection/detectors": detectors_stub(),
        "mirror_operations/functions": operations_stub(),
        "shape_analyses/functions": analyses_stub(),
    }.items():
        path = Path(stubs) / f"{name}.pyi"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(stub)


if __name__ == "__main__":
    main(*sys.argv[1:])
