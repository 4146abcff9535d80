"""The command line."""

from __future__ import annotations

import argparse
import signal
import sys
import time
from collections.abc import Sequence

from .._core import InvalidInput, InvalidParameter, __version__
from .commands import COMMANDS, overview, parser_of
from .suggestions import closest, with_suggestion
from .terminal import complain, drop_output, open_streams, say
from .values import attach_negative_numbers


def main(arguments: Sequence[str] | None = None) -> int:
    words = sys.argv[1:] if arguments is None else arguments
    # Of a process of its own when it started, before Python read its modules.
    began = time.time() - (time.process_time() if arguments is None else 0)
    open_streams()
    try:
        name, *rest = words or ["--help"]
        if name not in COMMANDS:
            return _without_command(name)
        chosen = parser_of(name).parse_args(
            attach_negative_numbers(rest), argparse.Namespace(began=began)
        )
        status = COMMANDS[name].run(chosen)
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # the reader, such as head, has seen enough
        drop_output()
        return 128 + getattr(signal, "SIGPIPE", 13)  # which Windows has not
    except (InvalidInput, InvalidParameter, ImportError) as error:  # an optional package
        complain(with_suggestion(str(error)))
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


def _without_command(word: str) -> int:
    if word in ("-h", "--help"):
        say("usage: symsurf COMMAND ...\n")
        say("Finds the mirror of 3D point sets and meshes: a plane, a sphere or a curved surface.")
        say(overview())
        say(
            "\nsymsurf COMMAND --help shows the options of a command, symsurf --version the version."
        )
        return 0
    if word == "--version":
        say(f"symsurf {__version__}")
        return 0
    kind = "option" if word.startswith("-") else "command"
    complain(f"there is no {kind} {word!r}{closest(word, COMMANDS)} symsurf --help lists all")
    return 2
