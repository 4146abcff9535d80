"""Writes the type stubs of what only exists at run time: the compiled module, and the functions
made from the descriptions of the methods.

Usage: generate_stubs.py BUILT STUBS. BUILT is the folder that holds the built package.
"""

from __future__ import annotations

import inspect
import sys
import textwrap
from pathlib import Path
from tempfile import TemporaryDirectory

import pybind11_stubgen


def compiled_stub() -> str:
    with TemporaryDirectory() as folder:
        pybind11_stubgen.main(["symsurf._core", "-o", folder, "--exit-code"])
        return (Path(folder) / "symsurf" / "_core.pyi").read_text()


def detectors_stub() -> str:
    from symsurf import detectors

    functions = [getattr(detectors, name) for name in detectors.__all__]
    lines = [
        "from numpy.typing import ArrayLike",
        "",
        "from .detection import Progress",
        "from .result import Result",
        "",
        f"__all__ = {detectors.__all__}",
    ]
    for function in functions:
        lines += ["", *_declaration(function.__name__, inspect.signature(function))]
        lines += textwrap.indent(f'"""{inspect.getdoc(function)}\n"""', "    ").splitlines()
    return "\n".join(lines) + "\n"


def _declaration(name: str, signature: inspect.Signature) -> list[str]:
    points, *keywords = signature.parameters.values()
    return [
        f"def {name}(",
        f"    {points.name}: {points.annotation},",
        "    *,",
        *(f"    {word.name}: {word.annotation} = {word.default!r}," for word in keywords),
        f") -> {signature.return_annotation}:",
    ]


def main(built: str, stubs: str) -> None:
    sys.path[0] = built  # not the sources beside this script
    folder = Path(stubs)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "_core.pyi").write_text(compiled_stub())
    (folder / "detectors.pyi").write_text(detectors_stub())


if __name__ == "__main__":
    main(*sys.argv[1:])
