"""How files name their axes: RAS or LPS, the directions that x, y and z increase towards in a patient."""

from __future__ import annotations

import re

# As 3D Slicer writes it into comments and titles, and into its tables of points.
SPACE = re.compile(rb"SPACE=(RAS|LPS)")
TABLE = re.compile(rb"^# CoordinateSystem = (RAS|LPS|0|1)\s*$", re.MULTILINE)
_NUMBERED = {b"0": "RAS", b"1": "LPS"}


def space_in(head: bytes) -> str | None:
    """ "RAS" or "LPS" where the beginning of a file says so."""
    found = SPACE.search(head) or TABLE.search(head)
    return None if found is None else _NUMBERED.get(found[1], found[1].decode())
