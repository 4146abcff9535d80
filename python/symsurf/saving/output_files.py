"""Where the results of many files go."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import chain
from pathlib import Path

from .._core import InvalidParameter
from ..reading import stem_of


def output_files(
    files: Sequence[Path], folder: Path, suffixes_of: Callable[[Path], Sequence[str]]
) -> dict[Path, list[Path]]:
    """The files to write to the folder for each file to read: none twice, none over an input."""
    outputs = {
        path: [folder / f"{stem_of(path)}{suffix}" for suffix in suffixes_of(path)]
        for path in files
    }
    require_apart(outputs)
    if folder.exists():
        folder.mkdir(exist_ok=True)  # refuses what is no folder
    return outputs


def require_apart(outputs: Mapping[Path, Sequence[Path]]) -> None:
    """Raises InvalidParameter where a file of those by the file to read would be written twice, or over
    one to read."""
    first: dict[Path, Path] = {}
    for path, made in outputs.items():
        for output in made:
            if first.setdefault(output, path) != path:
                raise InvalidParameter(
                    f"{first[output]} and {path} would both be written as {output.name}"
                )
    inputs = {path.resolve() for path in outputs}
    for output in chain.from_iterable(outputs.values()):
        if output.resolve() in inputs:
            raise InvalidParameter(f"{output} would overwrite an input; allowed is another name")
