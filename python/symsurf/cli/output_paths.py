"""What is asked of a file to write before the work is done."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Any

from .._core import InvalidParameter
from ..reading.formats import FORMATS
from ..results.operation_results import Correspondences
from ..saving.shape_files import formats_of
from .shared_options import Group

_FILES = {*FORMATS, *formats_of(Correspondences), ".png", ".html"}


def add_output(parser: Group, **words: Any) -> None:
    parser.add_argument("-o", "--output", **words)


def names_file(output: str) -> bool:
    """Whether it has the suffix of a format, and is no folder that is there or ends in a slash."""
    path = Path(output)
    is_folder = output.endswith(("/", "\\")) or path.is_dir()
    return path.suffix.lower() in _FILES and not is_folder


def require_suffix(name: str, path: Path, suffix: str) -> None:
    if path.suffix.lower() != suffix:
        raise InvalidParameter(f"{name} is {str(path)!r}; allowed is the suffix {suffix}")


def require_apart(path: Path, taken: Collection[Path]) -> None:
    """From the resolved inputs and other outputs."""
    if path.resolve() in taken:
        raise InvalidParameter(f"{path} is an input or another output; allowed is another name")
