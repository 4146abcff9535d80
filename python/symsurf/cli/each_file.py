"""Several files, of which one that fails does not stop the rest."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from .._core import InvalidInput
from .terminal import complain


def for_each_file(files: Iterable[Path], do: Callable[[Path], None]) -> int:
    """The exit status; one line for each file that failed."""
    failed = 0
    for path in files:
        try:
            do(path)
        except (InvalidInput, OSError, MemoryError) as error:
            if isinstance(error, OSError) and error.filename is None:
                raise  # it is the output that fails
            failed += 1
            reason = str(error) or type(error).__name__
            named = reason if str(path) in reason else f"{path}: {reason}"
            complain(" ".join(named.split()))
    return 1 if failed else 0
