"""What is written to the terminal: no name and no content of a file controls it."""

from __future__ import annotations

import argparse
import codecs
import errno
import os
import re
import sys
from io import BytesIO, TextIOWrapper
from typing import Any, NoReturn

from ..base.printable import escaped, printable
from ..reading.errors import naming
from ..reading.location import require_memory
from .suggestions import closest

_BLOCK = 1 << 20  # bytes of standard input that are read at once


def say(text: str) -> None:
    """On standard output, at once."""
    print(escaped(text), flush=True)


def complain(text: str) -> None:
    """On standard error, on one line."""
    print(f"symsurf: {printable(text)}", file=sys.stderr)


class _Help(argparse._HelpAction):
    """Shows of the options of the methods those of the method that was named before."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, *given: Any
    ) -> None:
        assert isinstance(parser, Parser)
        for action, texts in parser.help_of_methods.items():
            action.help = texts.get(namespace.method, argparse.SUPPRESS)
        super().__call__(parser, namespace, *given)


class Parser(argparse.ArgumentParser):
    """Of the command line, whose words may be names of files."""

    def __init__(self, **words: Any) -> None:
        super().__init__(**words | {"add_help": False})
        self.help_of_methods: dict[argparse.Action, dict[str, str]] = {}
        """Of an option, by the name of each method that has it."""
        self.add_argument("-h", "--help", action=_Help, help="show this and exit")

    def error(self, message: str) -> NoReturn:
        """Ends the program; with the nearest of the options for one that there is not."""
        unknown = re.search(r"unrecognized arguments: (--[\w-]+)", message)
        if unknown is not None:
            message += closest(unknown[1], self._option_string_actions)
        super().error(message)

    def _print_message(self, message: str, file: Any = None) -> None:
        super()._print_message(escaped(message), file)


def open_streams() -> None:
    """Where the caller has closed some, what is written is dropped, and no file takes their numbers."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 - to the end
    if isinstance(sys.stdout, TextIOWrapper):
        codecs.register_error("symsurf", _encoded)
        sys.stdout.reconfigure(errors="symsurf")


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


def drop_output() -> None:
    """What could not be written is not tried again at the end of the process."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def standard_input() -> bytes:
    """Raises OSError, which names it, where it is closed or cannot be read, InvalidInput where it does
    not end within half of the memory."""
    try:
        if sys.stdin is None:
            raise OSError(errno.EBADF, "It is closed")
        content = BytesIO()
        with naming("standard input"):
            while block := sys.stdin.buffer.read(_BLOCK):
                require_memory(content.tell() + len(block))
                content.write(block)
        return content.getvalue()
    except OSError as error:
        raise OSError(error.errno, error.strerror, "standard input") from error
