"""Writes what pages of the documentation have from elsewhere: tables of the descriptions, and code of the examples.

A block of a page begins with ``<!-- made: NAME WORD ... -->``, where NAME is that of a function in ``TABLES`` or of a file
beside the page, and ends with ``<!-- end -->``. Classes that a block lists get a page each. In place of some blocks, and of
those that begin with ``<!-- site: NAME WORD ... -->``, the site has all docstrings: ``extensions/from_descriptions.py``.

Usage: docs/tables.py [--check], with symsurf installed; ``--check`` writes nothing and fails if a block is not what would be
written.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import members

import symsurf
import symsurf.cli

DOCS = Path(__file__).resolve().parent
INCLUDED = DOCS.parent / "core" / "include" / "symsurf"
BLOCK = re.compile(
    r"(?P<begin><!-- (?P<kind>made|site): (?P<name>\S+)(?P<words>[^>]*) -->\n)(?P<content>.*?)(?P<end><!-- end -->)",
    re.DOTALL,
)
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


def functions(page: Path, *names: str) -> str:
    return table(("function", "what it does"), map(members.function_row, names))


def described(page: Path, folder: str) -> str:
    """The functions made from descriptions, each with its page."""
    prefix = "detect_" if folder == "methods" else ""
    return table(
        ("function", "what it does"),
        (
            (f"[`{prefix}{each.name}`]({_target(page, folder, each)})", each.summary)
            for each in FOLDERS[folder]().values()
        ),
    )


def module(page: Path, name: str) -> str:
    return table(("function", "what it does"), members.module_rows(name))


def classes(page: Path, *names: str) -> str:
    return table(
        ("class", "what it is"),
        (
            (
                f"[`{members.short(name)}`](classes/{members.short(name)}.md)",
                members.first_sentence(members.found(name)),
            )
            for name in names
        ),
    )


def class_(page: Path, name: str) -> str:
    """What bases with a page of their own have stands there."""
    described = members.found(name)
    pages = {base: page.with_name(f"{base.__name__}.md") for base in described.__mro__[1:]}
    elsewhere = [base for base, its_page in pages.items() if its_page.exists()]
    rows = members.class_rows(described, elsewhere)
    texts = [members.paragraphs(described)]
    texts += [
        f"With the members of [`{base.__name__}`]({pages[base].name})." for base in elsewhere[:1]
    ]
    return "\n\n".join([*texts, *([table(("member", "what it is"), rows)] if rows else [])])


def commands(page: Path) -> str:
    parsers = {name: symsurf.cli.parser_of(name) for name in symsurf.cli.COMMANDS}
    return table(
        ("command", "what it does"),
        (
            (f"`symsurf {name}`", " ".join(str(parser.description).split("\n\n")[0].split()))
            for name, parser in parsers.items()
        ),
    )


def cpp_headers(page: Path) -> str:
    return table(
        ("header", "what is there"),
        (
            (f"[`{each.name}`]({os.path.relpath(each, page.parent)})", _first_comment(each))
            for each in sorted(INCLUDED.glob("*.h"))
        ),
    )


def code(page: Path, name: str) -> str:
    file = (page.parent / name).resolve()
    return f"```{LANGUAGES[file.suffix]}\n{file.read_text().rstrip()}\n```"


TABLES = {
    each.__name__.rstrip("_"): each
    for each in (methods, operations, analyses, parameters, arrays, functions, described, module,
                 classes, class_, commands, cpp_headers)
}  # fmt: skip


def made(page: Path, text: str) -> str:
    """The page as it should be."""

    def block(match: re.Match[str]) -> str:
        if match["kind"] == "site":
            return match[0]
        name = match["name"]
        content = (
            TABLES[name](page, *match["words"].split()) if name in TABLES else code(page, name)
        )
        return f"{match['begin']}{content}\n{match['end']}"

    return BLOCK.sub(block, text)


def add_class_pages() -> None:
    for page in DOCS.rglob("*.md"):
        for match in BLOCK.finditer(page.read_text()):
            for name in match["words"].split() if match["name"] == "classes" else ():
                path = page.parent / "classes" / f"{members.short(name)}.md"
                if not path.exists():
                    path.write_text(
                        f"# {members.short(name)}\n\n<!-- made: class {name} -->\n<!-- end -->\n"
                    )


def _link(page: Path, folder: str, described: Any) -> str:
    return f"[`{described.name}`]({_target(page, folder, described)})"


def _target(page: Path, folder: str, described: Any) -> str:
    return Path(os.path.relpath(DOCS / folder / f"{described.name}.md", page.parent)).as_posix()


def _first_comment(header: Path) -> str:
    """Of the file, or of the first class in it."""
    comment = re.search(r"^(?:///? .*\n)+", header.read_text(), re.MULTILINE)
    return " ".join(comment[0].replace("/", "").split()) if comment else "All of them."


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
    if words != ["--check"]:
        add_class_pages()
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
