"""The command line. Each command is a module, or an object, with SUMMARY, add_arguments(parser) and
run(arguments), which returns the exit status."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from typing import Any

from .._core import InvalidInput, InvalidParameter, __version__, analyses, operations
from . import cohort, damage, demo, detect, evaluate, generate, methods, report, table
from .analyse import AnalysisCommand
from .operate import OperationCommand
from .terminal import Parser, complain, drop_output, open_streams
from .values import attach_negative_numbers

COMMANDS: dict[str, Any] = {
    "detect": detect,
    **{name: OperationCommand(operation) for name, operation in operations().items()},
    **{name: AnalysisCommand(analysis) for name, analysis in analyses().items()},
    "cohort": cohort,
    "report": report,
    "table": table,
    "generate": generate,
    "damage": damage,
    "evaluate": evaluate,
    "methods": methods,
    "demo": demo,
}


def main(arguments: Sequence[str] | None = None) -> int:
    words = sys.argv[1:] if arguments is None else arguments
    open_streams()
    try:
        chosen = parser().parse_args(attach_negative_numbers(words))
        status = chosen.run(chosen)
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # the reader, such as head, has seen enough
        drop_output()
        return 128 + getattr(signal, "SIGPIPE", 13)  # which Windows has not
    except (InvalidInput, InvalidParameter, ImportError) as error:  # an optional package
        complain(str(error))
        return 2
    except OSError as error:
        if error.filename is None:  # such as a full disk
            error.filename = "standard output"
            drop_output()
        complain(str(error))
        return 2
    except KeyboardInterrupt:
        if arguments is None:
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # one is enough
        return 130


def parser() -> Parser:
    top = Parser(
        prog="symsurf",
        description="Finds the mirror of 3D point sets: a plane, a sphere or a curved surface.",
        allow_abbrev=False,
    )
    top.add_argument("--version", action="version", version=f"symsurf {__version__}")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    for name, command in COMMANDS.items():
        sub = commands.add_parser(
            name,
            help=command.SUMMARY,
            description=command.SUMMARY,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )
        command.add_arguments(sub)
        sub.set_defaults(run=command.run)
    return top
