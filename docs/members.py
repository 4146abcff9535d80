"""Functions and classes of Python as rows of tables: how each is called, and the first sentence of its docstring."""

from __future__ import annotations

import ast
import importlib
import inspect
import itertools
import re
import textwrap
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import Any

Row = tuple[str, str]


def found(name: str) -> Any:
    """What a name of symsurf, or one with its module in front, stands for."""
    module, _, own = name.rpartition(".")
    return getattr(importlib.import_module(module or "symsurf"), own)


def short(name: str) -> str:
    return name.rpartition(".")[2]


def function_row(name: str) -> Row:
    return _called(short(name), found(name)), first_sentence(found(name))


def module_rows(name: str) -> Iterator[Row]:
    members = vars(importlib.import_module(name)).items()
    return (
        function_row(f"{name}.{own}")
        for own, member in members
        if not own.startswith("_") and getattr(member, "__module__", "") == name
    )


def class_rows(described: type, known: Iterable[type]) -> list[Row]:
    """Its fields, properties and methods, then those that it inherits, but from known classes and their bases."""
    rows: dict[str, Row] = {}
    inherited = {base for each in known for base in each.__mro__}
    for base in described.__mro__:
        if base in inherited or base.__module__ in ("builtins", "pybind11_builtins", "typing"):
            continue
        fields = {name: (f"`{name}`", _sentence(text)) for name, text in _field_texts(base).items()}
        methods = {
            name: (
                f"`{name}`"
                if isinstance(member, property | cached_property)
                else _called(name, member),
                first_sentence(member),
            )
            for name, member in ((name, inspect.getattr_static(base, name)) for name in vars(base))
            if isinstance(member, property | staticmethod | classmethod)
            or inspect.isroutine(member)
        }
        rows |= {name: row for name, row in (fields | methods).items() if name not in rows}
    return [row for name, row in rows.items() if not name.startswith("_") and row[1]]


def paragraphs(described: Any) -> str:
    """Its docstring in Markdown."""
    text = (inspect.getdoc(described) or "").replace("``", "`")
    return "\n\n".join(" ".join(each.split()) for each in text.split("\n\n"))


def first_sentence(described: Any) -> str:
    """In Markdown."""
    text = inspect.getdoc(described) or ""
    return _sentence(_COMPILED.sub("", text))


# What pybind11 writes in front: the signature, the first where there are several.
_COMPILED = re.compile(
    r"\A(?:\w+\(\*args, \*\*kwargs\)\nOverloaded function\.\n\n1\. )?\w+\((.*?)\) -> .*\n+"
)


def _sentence(text: str) -> str:
    first, *others = text.split("\n\n")
    line = " ".join([*first.split(), *(others[0].split() if first.endswith(":") else ())])
    return re.split(r"(?<=[.])\s(?=[A-Z`])", line.replace("``", "`"))[0]


def _called(name: str, function: Any) -> str:
    """The name with the arguments that need no name in the call."""
    function = getattr(function, "__func__", function)
    try:
        words = list(inspect.signature(function).parameters.values())
        names = [each.name for each in words if each.kind <= each.POSITIONAL_OR_KEYWORD]
        names += ["…"] if len(words) > len(names) else []
    except ValueError:  # a compiled one
        signature = _COMPILED.match(inspect.getdoc(function) or "")
        names = re.findall(r"(?:^|, )(\w+): ", signature[1]) if signature else []
    return f"`{name}({', '.join(each for each in names if each not in ('self', 'cls'))})`"


def _field_texts(described: type) -> dict[str, str]:
    """The texts below fields in the source, which Python itself does not keep."""
    try:
        (tree,) = ast.parse(textwrap.dedent(inspect.getsource(described))).body
    except (OSError, TypeError):  # a compiled one
        return {}
    return {
        field.target.id: text.value.value
        for field, text in itertools.pairwise(tree.body)  # type: ignore[attr-defined]
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)
        if isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant)
    }
