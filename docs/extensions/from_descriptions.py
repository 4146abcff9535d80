"""Pages made from the descriptions that the front ends are made from.

Functions that give Markdown, which stands on the site in place of the blocks of their name: ``docs/tables.py`` describes
these, and writes what the repository shows.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from sphinx.application import Sphinx
from tables import BLOCK, FOLDERS, table

import symsurf
import symsurf.cli

HOSTS = Path(os.environ["SYMSURF_DOCS_BUILD"]) / "hosts"


def functions(shown: str, *names: str) -> str:
    """Python's, with their docstrings."""
    full = (name if "." in name else f"symsurf.{name}" for name in names)
    return _rst(f".. autofunction:: {name}" for name in full)


def described(shown: str, folder: str) -> str:
    prefix = "detect_" if folder == "methods" else ""
    return functions(shown, *(prefix + name for name in FOLDERS[folder]()))


def module(shown: str, name: str) -> str:
    return _rst([f".. automodule:: {name}\n   :members:"])


def classes(shown: str, *names: str) -> str:
    """A table of them, with a page each."""
    pages = "\n".join(f"classes/{name.rpartition('.')[2]}" for name in names)
    return f"{shown}\n```{{toctree}}\n:hidden:\n\n{pages}\n```"


def class_(shown: str, name: str) -> str:
    return _rst(
        [f".. autoclass:: {name}\n   :members:\n   :inherited-members: object, tuple, dict"]
    )


def vtk_python(shown: str) -> str:
    import symsurf.vtk

    return _rst(
        f".. autoclass:: symsurf.vtk.{name}\n   :exclude-members: __init__"
        for name in symsurf.vtk.__all__
    )


def _rst(directives: Iterable[str]) -> str:
    return "```{eval-rst}\n" + "\n\n".join(directives) + "\n```"


def commands(shown: str) -> str:
    """The help of every command."""
    os.environ["COLUMNS"] = "88"  # argparse's width
    texts = [
        f"## {name}\n\n```text\n{symsurf.cli.parser_of(name).format_help()}```"
        for name in symsurf.cli.COMMANDS
    ]
    return "\n\n".join(texts)


def cpp_headers(shown: str) -> str:
    """Every header of the core, in the order of their names."""
    headers = sorted(Path(name).name for name in os.environ["SYMSURF_HEADERS"].split())
    return "\n\n".join(
        f"## {header}\n\n```{{doxygenfile}} {header}\n```"
        for header in headers
        if header != "symsurf.h"
    )


def vtk_classes(shown: str) -> str:
    xml = Path(os.environ["SYMSURF_DOCS_BUILD"]) / "doxygen" / "xml"
    names = sorted(path.stem[5:] for path in xml.glob("classvtk*.xml"))
    return "\n\n".join(
        f"### {name}\n\n```{{doxygenclass}} {name}\n:members:\n```" for name in names
    )


def paraview(shown: str) -> str:
    """Every filter and source as ParaView's server manager describes it."""
    texts = []
    for file in sorted((HOSTS / "paraview").glob("*.xml")):
        for group in ElementTree.parse(file).iter("ProxyGroup"):
            texts += map(_proxy, group)
    return "\n\n".join(texts)


def _proxy(proxy: ElementTree.Element) -> str:
    about = proxy.find("Documentation")
    text = " ".join(f"{about.get('long_help')} {about.text or ''}".split())
    ports = [port.get("name") for port in proxy.findall("OutputPort")]
    outputs = f"\n\nOutputs: {', '.join(f'*{port}*' for port in ports)}." if ports else ""
    rows = [
        (f"`{each.get('name')}`", f"`{each.get('default_values')}`" if each.get("default_values")
         else "", _said(each))
        for each in proxy
        if each.tag.endswith("Property") and each.find("Documentation") is not None
    ]  # fmt: skip
    return f"## {proxy.get('label')}\n\n{text}{outputs}\n\n" + table(
        ("property", "default", "what it is"), rows
    )


def _said(described: ElementTree.Element) -> str:
    """Its documentation; of a choice without what is said of each, which stands elsewhere."""
    text = " ".join((described.findtext("Documentation") or "").split())
    choices = [choice.get("value") for choice in described.iter("String")]
    if not choices:
        return text
    return text.split(f" - {choices[0]}: ")[0] + f" One of {', '.join(choices)}."


def meshlab(shown: str) -> str:
    """Every filter with the parameters that pymeshlab prints; one that nothing describes is an error."""
    printed = (HOSTS / "meshlab.txt").read_text()
    described = _meshlab_filters()
    texts = []
    for name, lines in re.findall(
        r"^(\w+) filter - list of parameter names:\n((?:\t.*\n?)*)", printed, re.MULTILINE
    ):
        summary, parameter_texts = described[name.split("_", 1)[1]]
        rows = (re.match(r"\t(\w+) : (\S+) = (.*)", line).groups() for line in lines.splitlines())
        texts.append(f"## {name}\n\n{summary}\n\n" + table(
            ("parameter", "default", "what it is"),
            ((f"`{parameter}`", f"`{default}`", parameter_texts[parameter])
             for parameter, _, default in rows),
        ))  # fmt: skip
    return "\n\n".join(texts)


# Parameters that MeshLab's filters share, and the section of docs/meshlab.md that describes them.
_SHARED = {
    **dict.fromkeys(
        ("only_selected", "use_normals", "use_faces", "show_candidates", "seed", "threads"),
        "[as in every filter](/meshlab.md#the-filters)",
    ),
    **dict.fromkeys(
        (
            "mirror_layer",
            "other_layer",
            "landmarks_layer",
            "landmarks_deviation",
            "find_mirror",
            "weigh_by_quality",
        ),
        "[as in every operation](/meshlab.md#operations)",
    ),
}


def _meshlab_filters() -> dict[str, tuple[str, dict[str, str]]]:
    """Of each filter, by its name without the first word: its summary, and a text a parameter."""
    described = {
        **{f"mirror_{each.name}": each for each in symsurf.methods().values()},
        **{each.title.lower().replace(" ", "_"): each for each in symsurf.operations().values()},
        **symsurf.analyses(),
    }
    shared = _SHARED | _texts_of([symsurf._core.require_found_parameter()])
    return {
        **{name: (each.summary, shared | _texts(each)) for name, each in described.items()},
        "mirror_reflection": (
            "[Reflects the current layer over a mirror](/meshlab.md#reflect-over-a-mirror).",
            {
                "mirror_layer": "The layer of a mirror, or one with all vertices on a plane or sphere."
            },
        ),
        "mirror_sample": (
            "[Makes points whose mirror is known](/meshlab.md#mirror-sample).",
            _texts_of_samples(),
        ),
    }


def _texts(described: Any) -> dict[str, str]:
    return _texts_of(described.parameters)


def _texts_of(parameters: Iterable[Any]) -> dict[str, str]:
    return {each.name: f"{each.doc} Allowed: {each.allowed}." for each in parameters}


def _texts_of_samples() -> dict[str, str]:
    generators = symsurf._core.generators()
    texts = {
        "generator": " ".join(f"`{each.name}`: {each.summary}" for each in generators.values()),
        "use_current_layer": "Mirrors the current layer's vertices in place of a sampled surface.",
    }
    for generator in generators.values():
        for name, text in _texts(generator).items():
            # Where generators differ in a parameter of one name, the filter puts theirs in front.
            texts.setdefault(name, text)
            texts[f"{generator.name}_{name}"] = text
    return texts


def link_examples(app: Sphinx, page: str, source: list[str]) -> None:
    """To the pages that are made of the scripts, in place of these."""
    source[0] = re.sub(
        r"\]\((?:\.\./)*examples/python(?:/(\w+)\.py)?\)",
        lambda match: f"](/how_to/{match[1] or 'index'}.rst)",
        source[0],
    )


def escape(app: Sphinx, what: str, *described: Any) -> None:
    """What docstrings hold that reStructuredText and Napoleon take for something else."""
    lines = described[-1]
    lines[:] = [re.sub(r"(?<!`)\|(?=[^`|]*\|)|(?<=\w)\|", r"\|", line) for line in lines]
    # Napoleon takes what stands before a colon in an attribute's first line for its type.
    if what in ("attribute", "property"):
        lines.insert(0, "\\")


def name_aliases(*described: Any) -> tuple[str | None, str | None]:
    """Sphinx shows names of types by an own class of its where they are one of several."""
    return tuple(text and re.sub(r"TypeAliasForwardRef\('(\w+)'\)", r"\1", text)
                 for text in described[-2:])  # fmt: skip


def printed(shown: str, name: str) -> str:
    """What an example printed when the site was made."""
    return f"```{{literalinclude}} {name}\n:language: text\n```"


FUNCTIONS = {
    each.__name__.rstrip("_"): each
    for each in (functions, described, module, classes, class_, vtk_python, commands, cpp_headers,
                 vtk_classes, paraview, meshlab, printed)
}  # fmt: skip


def fill_blocks(app: Sphinx, page: str, source: list[str]) -> None:
    def block(match: re.Match[str]) -> str:
        if match["name"] not in FUNCTIONS:
            return match[0]
        return FUNCTIONS[match["name"]](match["content"], *match["words"].split())

    source[0] = BLOCK.sub(block, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("source-read", fill_blocks)
    app.connect("source-read", link_examples)
    app.connect("autodoc-process-signature", name_aliases)
    app.connect("autodoc-process-docstring", escape, priority=400)  # before Napoleon
    return {"parallel_read_safe": True}
