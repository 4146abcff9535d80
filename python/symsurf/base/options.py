"""The options that functions, commands and filters share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Reading:
    """How a file, or a grid, becomes points."""

    threshold: float | None = None
    """Of a mask or an image, the number that the values of the points to take are above."""
    label: int | str | None = None
    """Of a map of labels, the value of the points to take; a text is the name of a segment."""
    scalars: str | None = None
    """The name of the values, of data that have several."""
    external_files: bool = False
    """Whether files that a file names may lie anywhere, and not only beside and below it."""

    def of_image(self) -> dict[str, Any]:
        """What chooses points of an image, where it is given, by its name."""
        return {
            name: value
            for name, value in vars(self).items()
            if name != "external_files" and value is not None
        }
