"""What readers raise, whatever a broken file does to them: InvalidInput, which names the file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

from .._core import InvalidInput, InvalidParameter
from ..base.own_process import ProcessDied
from ..base.printable import printable

_LONGEST = 1000  # letters of a reason, which may be any text of the file


@contextmanager
def naming(name: object) -> Iterator[None]:
    """InvalidInput raised within begins with the name of the file; see ``reason_of``."""
    try:
        yield
    except InvalidInput as error:
        raise InvalidInput(f"{name}: {reason_of(error)}") from error


@contextmanager
def broken(what: str) -> Iterator[None]:
    """All that a broken file may do to the code within is raised as InvalidInput. What is wrong with
    this package or the system stays what it is.

    Args:
        what: the format, such as "PLY".
    """
    try:
        yield
    except (InvalidInput, InvalidParameter):
        raise
    except ProcessDied as error:
        raise InvalidInput(
            f"broken {what} (its reader died, or took too much memory or time)"
        ) from error
    except MemoryError as error:
        raise InvalidInput("what the file holds does not fit into the memory") from error
    except OSError as error:
        raise InvalidInput(error.strerror or f"broken {what} ({_one_line(error)})") from error
    except Exception as error:  # what a package says of a broken file may be anything
        if _is_fault(error):
            raise
        raise InvalidInput(f"broken {what} ({_one_line(error)})") from error


def reason_of(error: Exception) -> str:
    """Its text, which may have texts of the file: on one line, escaped, and not longer than a reader
    wants."""
    text = str(error)
    return printable(text if len(text) <= _LONGEST else f"{text[:_LONGEST]} ...")


def _is_fault(error: Exception) -> bool:
    """Whether code names what is not there, such as a function that the system does not have."""
    if isinstance(error, AttributeError):
        return isinstance(error.obj, ModuleType)
    return isinstance(error, ImportError) or type(error) is NameError


def _one_line(error: Exception) -> str:
    return " ".join((str(error) or type(error).__name__).split())
