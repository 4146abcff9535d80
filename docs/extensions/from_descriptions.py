"""Pages made from the descriptions that the front ends are made from.

Functions that give Markdown, which pages call as substitutions, `{{ detectors() }}`. What pages have that
are read in the repository, too, ``docs/tables.py`` writes.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import os
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from sphinx.application import Sphinx
from tables import table

import symsurf
import symsurf.cli

HOSTS = Path(os.environ["SYMSURF_DOCS_BUILD"]) / "hosts"


def functions(names: Iterable[str]) -> str:
    """Python's, with their docstrings."""
    return _rst(f".. autofunction:: symsurf.{name}" for name in names)


def detectors() -> str:
    return functions(f"detect_{name}" for name in symsurf.methods())


def operating_functions() -> str:
    return functions(symsurf.operations())


def analysing_functions() -> str:
    return functions(symsurf.analyses())


def classes(names: Iterable[str]) -> str:
    """A table of them, with a page each, which ``write_class_pages`` writes."""
    rows = [
        (f"[`{_short(name)}`](classes/{_short(name)}.md)", _first_sentence(_object(name)))
        for name in names
    ]
    pages = "\n".join(f"classes/{_short(name)}" for name in names)
    return f"{table(('class', ''), rows)}\n\n```{{toctree}}\n:hidden:\n\n{pages}\n```"


def write_class_pages(app: Sphinx) -> None:
    folder = Path(app.srcdir, "reference", "python")
    (folder / "classes").mkdir(exist_ok=True)
    for page in folder.glob("*.md"):
        for names in re.findall(r"\{\{ classes\((\[.*?\])\) \}\}", page.read_text(), re.DOTALL):
            for name in ast.literal_eval(names):
                directive = f".. autoclass:: {name}\n   :members:\n   :inherited-members: object, tuple, dict"
                text = f"# {_short(name)}\n\n{_rst([directive])}\n"
                (folder / "classes" / f"{_short(name)}.md").write_text(text)


def _short(name: str) -> str:
    return name.rpartition(".")[2]


def _object(name: str) -> Any:
    module, _, own = name.rpartition(".")
    return getattr(importlib.import_module(module), own)


def _first_sentence(described: Any) -> str:
    """Of its documentation, in Markdown."""
    text = " ".join((inspect.getdoc(described) or "").split("\n\n")[0].split())
    return re.split(r"(?<=[.])\s(?=[A-Z])", text)[0].replace("``", "`")


def vtk_python() -> str:
    import symsurf.vtk

    return _rst(
        f".. autoclass:: symsurf.vtk.{name}\n   :exclude-members: __init__"
        for name in symsurf.vtk.__all__
    )


def _rst(directives: Iterable[str]) -> str:
    return "```{eval-rst}\n" + "\n\n".join(directives) + "\n```"


def commands() -> str:
    """The help of every command."""
    os.environ["COLUMNS"] = "88"  # argparse's width
    texts = [
        f"## {name}\n\n```text\n{symsurf.cli.parser_of(name).format_help()}```"
        for name in symsurf.cli.COMMANDS
    ]
    return "\n\n".join(texts)


def cpp_headers() -> str:
    """Every header of the core, in the order of their names."""
    headers = sorted(Path(name).name for name in os.environ["SYMSURF_HEADERS"].split())
    return "\n\n".join(
        f"## {header}\n\n```{{doxygenfile}} {header}\n```"
        for header in headers
        if header != "symsurf.h"
    )


def vtk_classes() -> str:
    xml = Path(os.environ["SYMSURF_DOCS_BUILD"]) / "doxygen" / "xml"
    names = sorted(path.stem[5:] for path in xml.glob("classvtk*.xml"))
    return "\n\n".join(
        f"### {name}\n\n```{{doxygenclass}} {name}\n:members:\n```" for name in names
    )


def paraview() -> str:
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


def meshlab() -> str:
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
        ("mirror_layer", "find_mirror", "weigh_by_quality"),
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


def setup(app: Sphinx) -> dict[str, bool]:
    app.config.myst_substitutions = {
        function.__name__: function
        for function in (detectors, operating_functions,
                         analysing_functions, functions, classes,
                         vtk_python, commands, cpp_headers, vtk_classes, paraview, meshlab)
    }  # fmt: skip
    app.connect("builder-inited", write_class_pages)
    app.connect("source-read", link_examples)
    app.connect("autodoc-process-signature", name_aliases)
    app.connect("autodoc-process-docstring", escape, priority=400)  # before Napoleon
    return {"parallel_read_safe": True}
