"""Writes what pages of the documentation have from elsewhere: tables of the descriptions, and code of the examples.

A block of a page begins with ``<!-- made: methods -->``, ``operations``, ``analyses``, ``parameters``, ``arrays`` or the
name of a file beside the page, and ends with ``<!-- end -->``. Usage: docs/tables.py [--check], with symsurf installed;
``--check`` writes nothing and fails if a block is not what would be written.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import symsurf

DOCS = Path(__file__).resolve().parent
BLOCK = re.compile(r"(<!-- made: (\S+) -->\n).*?(<!-- end -->)", re.DOTALL)
FOLDERS = {
    "methods": symsurf.methods,
    "operations": symsurf.operations,
    "symmetries": symsurf.analyses,
}
LANGUAGES = {".cpp": "cpp", ".py": "python", ".txt": "cmake"}


def table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    lines = [list(header), ["---"] * len(list(header)), *map(list, rows)]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines
    )


def methods(page: Path) -> str:
    return table(
        ("method", "what it does", "least points"),
        (
            (_link(page, "methods", each), each.summary, str(each.minimum_points))
            for each in symsurf.methods().values()
        ),
    )


def operations(page: Path) -> str:
    return table(
        ("operation", "what it does"),
        ((_link(page, "operations", each), each.summary) for each in symsurf.operations().values()),
    )


def analyses(page: Path) -> str:
    return table(
        ("analysis", "what it does"),
        ((_link(page, "symmetries", each), each.summary) for each in symsurf.analyses().values()),
    )


def parameters(page: Path) -> str:
    return table(
        ("parameter", "default", "allowed", "what it is"),
        (
            (f"`{each.name}`", f"`{_shown(each.default)}`", each.allowed, each.doc)
            for each in _described(page).parameters
        ),
    )


def arrays(page: Path) -> str:
    return table(
        ("array", "of each point", "what it is"),
        (
            (f"`{each.name}`", f"{each.components} {each.type}", each.doc)
            for each in _described(page).arrays
        ),
    )


def code(page: Path, name: str) -> str:
    file = (page.parent / name).resolve()
    return f"```{LANGUAGES[file.suffix]}\n{file.read_text().rstrip()}\n```"


def made(page: Path, text: str) -> str:
    """The page as it should be."""
    tables = {each.__name__: each for each in (methods, operations, analyses, parameters, arrays)}

    def block(match: re.Match[str]) -> str:
        name = match[2]
        content = tables[name](page) if name in tables else code(page, name)
        return f"{match[1]}{content}\n{match[3]}"

    return BLOCK.sub(block, text)


def _link(page: Path, folder: str, described: Any) -> str:
    target = os.path.relpath(DOCS / folder / f"{described.name}.md", page.parent)
    return f"[`{described.name}`]({Path(target).as_posix()})"


def _described(page: Path) -> Any:
    return FOLDERS[page.parent.name]()[page.stem]


def _shown(value: Any) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if hasattr(value, "tolist"):
        return str(value.tolist())
    return f"{value:g}" if isinstance(value, float) else str(value)


def main(words: list[str]) -> int:
    stale = 0
    for page in sorted(DOCS.rglob("*.md")):
        text = page.read_text()
        wanted = made(page, text)
        if text != wanted:
            stale += 1
            print(page.relative_to(DOCS))
            if words != ["--check"]:
                page.write_text(wanted)
    return 1 if stale and words == ["--check"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
