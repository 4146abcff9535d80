"""Several files, of which one that fails does not stop the rest."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from pathlib import Path

from .._core import InvalidInput, InvalidParameter


def for_each_file(files: Iterable[Path], do: Callable[[Path], None]) -> int:
    """The exit status; one line a file that failed."""
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
            print("symsurf:", " ".join(named.split()), file=sys.stderr)
    return 1 if failed else 0


def output_files(
    files: Sequence[Path], folder: Path, suffixes: Sequence[str]
) -> dict[Path, list[Path]]:
    """The files to write to the folder for each file to read: none twice, none over an input."""
    stems: dict[str, Path] = {}
    for path in files:
        if stems.setdefault(path.stem, path) != path:
            raise InvalidParameter(
                f"{stems[path.stem]} and {path} would both be written as {path.stem}{suffixes[0]}"
            )
    outputs = {path: [folder / f"{path.stem}{suffix}" for suffix in suffixes] for path in files}
    inputs = {path.resolve() for path in files}
    for output in chain.from_iterable(outputs.values()):
        if output.resolve() in inputs:
            raise InvalidParameter(f"{output} would overwrite an input; allowed is another folder")
    if folder.exists():
        folder.mkdir(exist_ok=True)  # refuses what is no folder
    return outputs
