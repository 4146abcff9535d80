"""Pictures of the demonstration: one for each case, and for each thing done."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from .demonstration import Case, Deed, Finding


def draw(findings: Sequence[Finding], deeds: Sequence[Deed], folder: Path) -> Iterator[Path]:
    """Writes the pictures, naming each when it is there."""
    for finding in findings:
        path = folder / f"{file_name(finding.case)}.png"
        finding.result.plot(path, shape=finding.case.shape)
        yield path
    for deed in deeds:
        path = folder / f"{file_name(deed.case)}-{deed.result.operation}.png"
        deed.result.plot(path)
        yield path


def file_name(case: Case) -> str:
    return f"{case.name} {case.change}".replace(" ", "-")
