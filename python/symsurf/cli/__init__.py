"""The command line. Each command is a module, or an object, with SUMMARY, add_arguments(parser) and
run(arguments), which returns the exit status."""

from __future__ import annotations

import argparse
import codecs
import os
import signal
import sys
from collections.abc import Sequence
from io import TextIOWrapper
from typing import Any

from .._core import InvalidInput, InvalidParameter, __version__, analyses, operations
from . import cohort, damage, demo, detect, evaluate, generate, methods, report, table
from .analyse import AnalysisCommand
from .operate import OperationCommand
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
    if isinstance(sys.stdout, TextIOWrapper):
        codecs.register_error("symsurf", _encoded)
        sys.stdout.reconfigure(errors="symsurf")
    try:
        chosen = parser().parse_args(attach_negative_numbers(words))
        status = chosen.run(chosen)
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # the reader, such as head, has seen enough
        _drop_output()
        return 128 + getattr(signal, "SIGPIPE", 13)  # which Windows has not
    except (InvalidInput, InvalidParameter, ImportError) as error:  # an optional package
        print(f"symsurf: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        if error.filename is None:  # such as a full disk
            error.filename = "standard output"
            _drop_output()
        print(f"symsurf: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130


def _encoded(error: UnicodeError) -> tuple[str | bytes, int]:
    """A character that the terminal has not: the byte of a file's name as it is, others as \\x, \\u."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    first = UnicodeEncodeError(
        error.encoding, error.object, error.start, error.start + 1, error.reason
    )
    try:
        return codecs.lookup_error("surrogateescape")(first)
    except UnicodeEncodeError:
        return codecs.backslashreplace_errors(first)


def _drop_output() -> None:
    """What could not be written is not tried again at the end of the process."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(
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
