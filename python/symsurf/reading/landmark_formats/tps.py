"""TPS, of tpsDig and those who follow it (Rohlf)."""

from __future__ import annotations

import re
from pathlib import Path, PureWindowsPath

from ..._core import InvalidInput
from ...shapes import Landmarks
from ..location import text_of
from .rows import Row, coordinates, number

_WORD = re.compile(r"[A-Za-z]\w*")


def read(path: Path) -> list[Landmarks]:
    """Those of each specimen, times its scale. Points along curves and outlines are left out."""
    lines = [(n, line) for n, line in enumerate(text_of(path).splitlines(), 1) if line.strip()]
    starts = [index for index, (_, line) in enumerate(lines) if _key(line) in ("LM", "LM3")]
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
        if _key(text):
            break
        rows.append((line, text.split()))
    if len(rows) != int(count):
        raise InvalidInput(f"line {first}: {len(rows)} landmarks follow; it promises {count}")
    said = {key: (line, _value(text)) for line, text in reversed(lines) if (key := _key(text))}
    points = coordinates(rows)
    if "SCALE" in said:
        points = points * number(said["SCALE"][1], said["SCALE"][0])
    image = said.get("IMAGE", (0, ""))[1]
    specimen = said.get("ID", (0, ""))[1] or PureWindowsPath(image).stem
    return Landmarks(points, specimen=specimen, image=image)


def _key(text: str) -> str:
    """The word before "=", in capitals; none: empty."""
    word, sign, _ = text.partition("=")
    return word.strip().upper() if sign and _WORD.fullmatch(word.strip()) else ""


def _value(text: str) -> str:
    return text.partition("=")[2].strip()
