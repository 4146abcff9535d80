"""Texts that do not control the terminal that they are written to."""

from __future__ import annotations

import re

# All of Unicode's control characters but tabs and ends of lines, the bytes of names that may stand
# for such, what else ends lines, and what turns the direction of writing.
_CONTROLS = re.compile(
    "[\0-\x08\x0b-\x1f\x7f-\x9f\udc80-\udc9f\u200e\u200f\u2028-\u202e\u2066-\u2069]"
)


def escaped(text: str) -> str:
    """The text with control characters as "\\x1b", but for tabs and ends of lines."""
    return _CONTROLS.sub(lambda found: ascii(found[0])[1:-1], text)


def printable(text: str) -> str:
    """The same on one line."""
    return escaped(text).replace("\t", "\\t").replace("\n", "\\n")
