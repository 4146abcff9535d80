"""TPS, of tpsDig and those who follow it (Rohlf)."""

from __future__ import annotations

import re
from pathlib import Path, PureWindowsPath

from ..._core import InvalidInput
from ...shapes import Landmarks
from ..location import text_of
from .rows import Row, coordinates, number

_KEY = re.compile(r"\s*([A-Za-z]\w*)\s*=\s*(.*?)\s*$")


def read(path: Path) -> list[Landmarks]:
    """Those of each specimen, times its scale. Points along curves and outlines are left out."""
    lines = [(n, line) for n, line in enumerate(text_of(path).splitlines(), 1) if line.strip()]
    keys = [(index, found) for index, (_, line) in enumerate(lines) if (found := _KEY.match(line))]
    starts = [index for index, found in keys if found[1].upper() in ("LM", "LM3")]
    if not starts and lines:
        raise InvalidInput("there is no line LM= or LM3=")
    ends = [*starts[1:], len(lines)]
    return [_specimen(lines[start:end]) for start, end in zip(starts, ends, strict=True)]


def _specimen(lines: list[tuple[int, str]]) -> Landmarks:
    first, count = lines[0][0], _value(lines[0][1])
    if not count.isdecimal():
        raise InvalidInput(f"line {first}: {count!r:.40} is no number of landmarks")
    rows: list[Row] = []
    for line, text in lines[1:]:
        if _KEY.match(text):
            break
        rows.append((line, text.split()))
    if len(rows) != int(count):
        raise InvalidInput(f"line {first}: {len(rows)} landmarks follow; it promises {count}")
    said = {
        match[1].upper(): (line, match[2])
        for line, text in reversed(lines)
        if (match := _KEY.match(text))
    }
    points = coordinates(rows)
    if "SCALE" in said:
        points = points * number(said["SCALE"][1], said["SCALE"][0])
    image = said.get("IMAGE", (0, ""))[1]
    specimen = said.get("ID", (0, ""))[1] or PureWindowsPath(image).stem
    return Landmarks(points, specimen=specimen, image=image)


def _value(text: str) -> str:
    return text.partition("=")[2].strip()
