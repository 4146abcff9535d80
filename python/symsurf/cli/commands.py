"""The commands, in the groups that help shows, each with an example."""

from __future__ import annotations

import argparse
import re
import textwrap
from typing import Any

from .._core import analyses, operations
from . import cohort, damage, demo, detect, evaluate, generate, methods, report, table
from .analyse import AnalysisCommand
from .completion import CompletionCommand
from .operate import OperationCommand
from .terminal import Parser

GROUPS: dict[str, dict[str, Any]] = {
    "Find the mirror": {"detect": detect},
    "Work with the mirror (it is found first, unless --mirror names one)": {
        name: OperationCommand(operation) for name, operation in operations().items()
    },
    "Find other symmetries": {
        name: AnalysisCommand(analysis) for name, analysis in analyses().items()
    },
    "Reports, tables and cohorts": {"report": report, "table": table, "cohort": cohort},
    "Samples with a known mirror": {"generate": generate, "damage": damage, "evaluate": evaluate},
    "About symsurf": {
        "methods": methods,
        "demo": demo,
        "completion": CompletionCommand(lambda: map(parser_of, COMMANDS)),
    },
}
"""Each is a module, or an object, with SUMMARY, add_arguments(parser) and run(arguments), which
returns the exit status."""

COMMANDS: dict[str, Any] = {
    name: command for group in GROUPS.values() for name, command in group.items()
}

_EXAMPLES = {
    "detect": "scan.ply --plot -o results",
    "asymmetry": "scan.ply -o asymmetry.vtp",
    "correspondences": "scan.ply -o pairs.csv",
    "align": "scan.ply --axis x -o upright.ply",
    "complete": "scan.ply -o whole.ply",
    "symmetrize": "scan.ply --side positive -o even.ply",
    "straighten": "scan.ply -o straight.ply",
    "remesh": "mesh.ply -o even.stl",
    "cut": "mesh.ply --side positive -o half.stl",
    "transfer": "mesh.ply --side positive -o both.ply",
    "illuminate": "screen.ply --mirror mirror.json --light 0,0,2 -o lit.vtp",
    "symmetries": "part.ply -o group.json",
    "match_pair": "left.ply --other right.ply",
    "report": "scan.ply -o report.html",
    "table": "merge first.csv second.csv -o all.csv",
    "cohort": "landmarks/*.csv --table anova.csv",
    "generate": "spherical -o sample.xyz",
    "damage": "noise sample.xyz --low 0 --high 0.01 -o noisy.xyz",
    "evaluate": "found.txt --sample sample.xyz",
    "methods": "",
    "demo": "-o symsurf-demo",
    "completion": "bash",
}


def example_of(name: str) -> str:
    return f"symsurf {name} {_EXAMPLES.get(name, 'scan.ply --json')}".rstrip()


def overview() -> str:
    """All commands by groups: what each does, and its example."""
    lines = []
    for title, commands in GROUPS.items():
        lines += ["", f"{title}:"]
        for name, command in commands.items():
            about = textwrap.wrap(f"{re.split('[:;(]', command.SUMMARY)[0].strip(' .')}.", 58)
            texts = zip([name, *[""] * len(about)], [*about, f"$ {example_of(name)}"])
            lines += [f"  {first:<19} {text}" for first, text in texts]
    return "\n".join(lines)


def parser_of(name: str) -> Parser:
    """That of the command."""
    command = COMMANDS[name]
    parser = Parser(
        prog=f"symsurf {name}",
        description=f"{textwrap.fill(command.SUMMARY, 78)}\n\n  $ {example_of(name)}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    command.add_arguments(parser)
    words = [each.metavar for each in parser._get_positional_actions() if each.nargs != "?"]
    parser.usage = f"%(prog)s {' '.join(map(str, words))} ... [OPTIONS]"
    return parser
