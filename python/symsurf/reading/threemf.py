"""3MF by its core and its production specification."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any
from xml.etree.ElementTree import iterparse
from zipfile import ZipFile

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..shapes import Choice, Shape
from .location import require_memory
from .parts import Part, joined, transformed

_MODEL = (
    "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"  # the type of a relationship
)
_PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
# Extensions that change no point, and those that are read.
_KNOWN = (
    "http://schemas.microsoft.com/3dmanufacturing/core/",
    "http://schemas.microsoft.com/3dmanufacturing/material/",
    "http://schemas.microsoft.com/3dmanufacturing/production/",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/",
)


_MOST_USES = 100_000  # of objects: each may be made of two that are made of two, and so on


class _Object:
    def __init__(self) -> None:
        self.points: list[tuple[float, float, float]] = []
        self.faces: list[tuple[int, int, int]] = []
        self.components: list[tuple[str, str, NDArray[np.float64]]] = []


class _Model:
    """A file of the archive with objects by their numbers, and what is built of which."""

    def __init__(self, file: IO[bytes], name: str) -> None:
        self.objects: dict[str, _Object] = {}
        self.items: list[tuple[str, str, NDArray[np.float64]]] = []
        spaces: dict[str, str] = {}
        current = _Object()
        for event, what in iterparse(file, ("start-ns", "start", "end")):
            if event == "start-ns":
                spaces[what[0]] = what[1]
                continue
            tag, given = what.tag.rpartition("}")[2], what.attrib
            if event == "end":
                if tag in ("vertex", "triangle", "object"):
                    what.clear()
                continue
            if tag == "model":
                _require_known(given.get("requiredextensions", ""), spaces)
            elif tag == "object":
                current = self.objects[given["id"]] = _Object()
            elif tag == "vertex":
                current.points.append((float(given["x"]), float(given["y"]), float(given["z"])))
            elif tag == "triangle":
                current.faces.append((int(given["v1"]), int(given["v2"]), int(given["v3"])))
            elif tag in ("component", "item"):
                path = given.get(f"{{{_PRODUCTION}}}path", name).lstrip("/")
                entry = (path, given["objectid"], _matrix(given.get("transform")))
                (current.components if tag == "component" else self.items).append(entry)


def read(path: Path, choice: Choice) -> Shape:
    """All that is built, each object where it is built, as one shape."""
    with ZipFile(path) as archive:
        require_memory(sum(each.file_size for each in archive.infolist()))
        return joined(_built(archive))


def _built(archive: ZipFile) -> Iterator[Part]:
    names = {name.lower(): name for name in archive.namelist()}
    models: dict[str, _Model] = {}
    uses = 0

    def model(name: str) -> _Model:
        if name not in models:
            if name.lower() not in names:
                raise InvalidInput(f"the archive has no file {name}")
            with archive.open(names[name.lower()]) as file:
                models[name] = _Model(file, name)
        return models[name]

    def parts(name: str, number: str, matrix: NDArray[np.float64], above: tuple[Any, ...]) -> Any:
        if (name, number) in above:
            raise InvalidInput(f"object {number} is a part of itself")
        nonlocal uses
        uses += 1
        if uses > _MOST_USES:
            raise InvalidInput(
                f"more than {_MOST_USES} objects are built, which are the most allowed"
            )
        if number not in model(name).objects:
            raise InvalidInput(f"there is no object {number}")
        own = model(name).objects[number]
        if own.points:
            points = np.array(own.points)
            faces = np.array(own.faces, np.int64).reshape(-1, 3)
            if len(faces) and not 0 <= faces.min() <= faces.max() < len(points):
                raise InvalidInput(
                    f"a face names point {faces.max()}; there are {len(points)} points"
                )
            yield transformed(points, faces, matrix)
        for other, part, inner in own.components:
            yield from parts(other, part, matrix @ inner, (*above, (name, number)))

    root = _root(archive, names)
    for name, number, matrix in model(root).items:
        yield from parts(name, number, matrix, ())


def _root(archive: ZipFile, names: dict[str, str]) -> str:
    """The model that the archive's relationships name."""
    if "_rels/.rels" in names:
        with archive.open(names["_rels/.rels"]) as file:
            for _, each in iterparse(file):
                if each.get("Type") == _MODEL:
                    return posixpath.normpath(each.get("Target", "")).lstrip("/")
    return "3D/3dmodel.model"


def _require_known(prefixes: str, spaces: dict[str, str]) -> None:
    for prefix in prefixes.split():
        space = spaces.get(prefix, prefix)
        if not space.startswith(_KNOWN):
            raise InvalidInput(f"it requires the extension {space}, which cannot be read")


def _matrix(text: str | None) -> NDArray[np.float64]:
    """3MF multiplies rows from the left, and leaves out the last column."""
    matrix = np.eye(4)
    if text is not None:
        matrix[:3] = np.array(text.split(), dtype=float).reshape(4, 3).T
    return matrix
