"""The way up between the layers of the package, which docs/architecture.md describes."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from importlib.util import resolve_name
from pathlib import Path
from typing import NamedTuple

from conftest import ROOT
from test_import import HEAVY

PACKAGE = ROOT / "python" / "symsurf"

# Folders and files from the lowest layer up: a module imports from its own layer and from lower ones.
LAYERS = (
    "_core", "base", "shapes", "reflection", "reading", "results",
    "detection", "mirror_operations", "shape_analyses", "morphometrics",
    "saving", "plotting", "report",
    "benchmark", "synthetic", "metrics", "thesis", "batching", "demonstration",
    "vtk", "accessor", "cli", "__main__", "__init__",
)  # fmt: skip


def name_of(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


SOURCES = {name_of(path): path for path in PACKAGE.rglob("*.py")}
NAMES = {*SOURCES, "symsurf._core"}


class Import(NamedTuple):
    module: str
    imported: str
    when: str
    """At the "start", at a "call" of a function, or for "typing" alone."""


def imports_of(module: str) -> Iterator[Import]:
    path = SOURCES[module]
    tree = ast.parse(path.read_text())
    package = module if path.stem == "__init__" else module.rpartition(".")[0]
    when = dict.fromkeys(ast.walk(tree), "start")
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            when |= dict.fromkeys((n for part in node.body for n in ast.walk(part)), "typing")
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            when |= dict.fromkeys(ast.walk(node), "call")
    for node in when:
        names = [each.name for each in getattr(node, "names", ()) if isinstance(each, ast.alias)]
        if isinstance(node, ast.ImportFrom):
            base = resolve_name("." * node.level + (node.module or ""), package)
            names = [full if (full := f"{base}.{name}") in NAMES else base for name in names]
        yield from (Import(module, name, when[node]) for name in names)


IMPORTS = [each for module in SOURCES for each in imports_of(module)]


def layer_of(module: str) -> int:
    return LAYERS.index((module.split(".") + ["__init__"])[1])


def test_every_module_lies_in_a_layer():
    assert len(IMPORTS) > 500
    assert {layer_of(module) for module in NAMES} == set(range(len(LAYERS)))


def test_layers_import_only_lower_ones():
    own = [each for each in IMPORTS if each.imported in NAMES]
    assert [each for each in own if layer_of(each.imported) > layer_of(each.module)] == []


def test_no_modules_import_each_other_in_a_circle():
    used: dict[str, set[str]] = {}
    for each in IMPORTS:
        used.setdefault(each.module, set()).add(each.imported)
    TopologicalSorter(used).prepare()


def test_imports_inside_functions_delay_what_the_package_does_not_wait_for():
    def is_heavy(name: str) -> bool:
        if any(f"{name}.".startswith(f"{heavy}.") for heavy in HEAVY):
            return True
        at_start = (i.imported for i in IMPORTS if i.module == name and i.when == "start")
        return any(is_heavy(imported) for imported in at_start)

    late = [each for each in IMPORTS if each.when == "call"]
    assert [each for each in late if not is_heavy(each.imported)] == []


def test_no_other_way_of_importing():
    by_name = {name for name, path in SOURCES.items() if "import_module(" in path.read_text()}
    # An optional package, what another process is asked for, and the modules beside it.
    names = (
        "base.optional",
        "base.own_process",
        "reading.formats",
        "reading.in_chunks",
        "shapes.objects",
    )
    assert by_name == {f"symsurf.{name}" for name in names}
    assert not any("__import__" in path.read_text() for path in SOURCES.values())
