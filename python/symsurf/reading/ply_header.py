"""What the header of a PLY file says."""

from __future__ import annotations

import re
from dataclasses import dataclass

TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
"""Of properties, as NumPy names them without their byte order."""

END = re.compile(rb"^[ \t]*end_header(?:[ \t].*)?\r?\n", re.MULTILINE)
"""Its last line."""


@dataclass
class Element:
    name: bytes
    count: int
    line: int
    """In the header."""
    properties: list[list[bytes]]
    """The words of each after "property"."""


def elements_of(lines: list[bytes]) -> list[Element]:
    elements: list[Element] = []
    for number, line in enumerate(lines):
        words = line.split()
        if words[:1] == [b"element"]:
            elements.append(Element(words[1], int(words[2]), number, []))
        elif words[:1] == [b"property"]:
            elements[-1].properties.append(words[1:])
    return elements
