"""Pictures of the demonstration, one for each case."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from .demonstration import Finding


def draw(findings: list[Finding], folder: Path) -> Iterator[Path]:
    """Writes the pictures, naming each when it is there."""
    for finding in findings:
        case = finding.case
        path = folder / f"{case.name} {case.damage}.png".replace(" %", "").replace(" ", "-")
        finding.result.plot(path, shape=case.shape)
        yield path
