"""What symsurf is installed from."""

from __future__ import annotations

from pathlib import Path

from packaging.requirements import Requirement
from packaging.tags import sys_tags
from packaging.utils import InvalidWheelFilename, parse_wheel_filename


def requirements(resources: Path) -> list[Requirement]:
    """Those of ``requirements.txt`` in the module's resources, met by the wheels that lie beside it in
    ``wheels`` and fit this Python; the others come from the package index."""
    lines = (resources / "requirements.txt").read_text().splitlines()
    named = [Requirement(line) for line in lines if line and not line.startswith("#")]
    wheels = _fitting_wheels(resources / "wheels")
    return [
        Requirement(f"{each.name} @ {wheels[each.name].as_uri()}") if each.name in wheels else each
        for each in named
    ]


def _fitting_wheels(folder: Path) -> dict[str, Path]:
    """By the name of the package, the newest version of each."""
    tags = set(sys_tags())
    found: dict[str, tuple[object, Path]] = {}
    for path in folder.glob("*.whl"):
        try:
            name, version, _, own = parse_wheel_filename(path.name)
        except InvalidWheelFilename:
            continue
        if tags & own and (name not in found or version > found[name][0]):
            found[name] = version, path.resolve()
    return {name: path for name, (_, path) in found.items()}
