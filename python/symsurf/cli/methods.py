"""symsurf methods: what there is, from the descriptions."""

from __future__ import annotations

import argparse
import json
import textwrap
from typing import Any

from .._core import Method, Parameter
from .._core import methods as all_methods
from ..base.plain import plain, shown
from .terminal import say

SUMMARY = "Lists the methods and their parameters."


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    if arguments.json:
        say(json.dumps({name: _record(method) for name, method in all_methods().items()}, indent=1))
    else:
        say("\n\n".join(_text(method) for method in all_methods().values()))
    return 0


def _record(method: Method) -> dict[str, Any]:
    return {
        "name": method.name,
        "title": method.title,
        "summary": method.summary,
        "minimum_points": method.minimum_points,
        "automatic": method.automatic,
        "parameters": [_parameter_record(parameter) for parameter in method.parameters],
    }


def _parameter_record(parameter: Parameter) -> dict[str, Any]:
    names = ("name", "type", "unit", "default", "range", "minimum", "maximum", "choices", "doc")
    return {name: plain(getattr(parameter, name)) for name in names}


def _text(method: Method) -> str:
    lines = [method.name, textwrap.indent(textwrap.fill(method.summary, 92), "    ")]
    for parameter in method.parameters:
        about = f"{parameter.allowed}, default {shown(parameter.default)}"
        lines.append(f"  --{parameter.name.replace('_', '-')}  {about}")
        lines.append(textwrap.indent(textwrap.fill(parameter.doc, 92), "      "))
    return "\n".join(lines)
