"""3MF by its core and its production specification."""

from __future__ import annotations

import posixpath
from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any
from xml.etree.ElementTree import XMLParser, iterparse
from zipfile import ZipFile

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput
from ..base.options import Reading
from ..shapes import Shape
from .location import require_memory
from .parts import Part, joined, require_parts

_MODEL = (
    "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"  # the type of a relationship
)
_BLOCK = 1 << 20  # bytes that are unpacked at once
_PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
# Extensions that change no point, and those that are read.
_KNOWN = (
    "http://schemas.microsoft.com/3dmanufacturing/core/",
    "http://schemas.microsoft.com/3dmanufacturing/material/",
    "http://schemas.microsoft.com/3dmanufacturing/production/",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/",
)


class _Object:
    def __init__(self) -> None:
        self.numbers = array("d")  # three of each point
        self.corners = array("q")  # three of each face
        self.components: list[tuple[str, str, NDArray[np.float64]]] = []

    def made(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        points = np.frombuffer(self.numbers).reshape(-1, 3)
        faces = np.frombuffer(self.corners, np.int64).reshape(-1, 3)
        if len(faces) and not 0 <= faces.min() <= faces.max() < len(points):
            raise InvalidInput(f"a face names point {faces.max()}; there are {len(points)} points")
        return points, faces


class _Model:
    """A file of the archive with objects by their numbers, and what is built of which. It is what an
    XMLParser calls: a tree of the elements would take ten times the memory of the text."""

    def __init__(self, file: IO[bytes], name: str) -> None:
        self.objects: dict[str, _Object] = {}
        self.items: list[tuple[str, str, NDArray[np.float64]]] = []
        self._name = name
        self._entries = 0
        self._spaces: dict[str, str] = {}
        self._current = _Object()
        parser = XMLParser(target=self)
        while block := file.read(_BLOCK):
            parser.feed(block)
        parser.close()

    def start_ns(self, prefix: str, space: str) -> None:
        self._spaces[prefix] = space

    def start(self, tag: str, given: dict[str, str]) -> None:
        tag = tag.rpartition("}")[2]
        if tag == "vertex":
            self._current.numbers.extend((float(given["x"]), float(given["y"]), float(given["z"])))
        elif tag == "triangle":
            self._current.corners.extend((int(given["v1"]), int(given["v2"]), int(given["v3"])))
        elif tag == "model":
            _require_known(given.get("requiredextensions", ""), self._spaces)
        elif tag in ("object", "component", "item"):
            self._entries += 1
            require_parts(self._entries)
            self._add(tag, given)

    def _add(self, tag: str, given: dict[str, str]) -> None:
        if tag == "object":
            self._current = self.objects[given["id"]] = _Object()
        else:
            path = given.get(f"{{{_PRODUCTION}}}path", self._name).lstrip("/")
            entry = (path, given["objectid"], _matrix(given.get("transform")))
            (self._current.components if tag == "component" else self.items).append(entry)


def read(path: Path, reading: Reading) -> Shape:
    """All that is built, each object where it is built, as one shape."""
    with ZipFile(path) as archive:
        require_memory(sum(each.file_size for each in archive.infolist()))
        return joined(_built(archive), path.stat().st_size)


def _built(archive: ZipFile) -> Iterator[Part]:
    names = {name.lower(): name for name in archive.namelist()}
    models: dict[str, _Model] = {}

    def model(name: str) -> _Model:
        if name not in models:
            if name.lower() not in names:
                raise InvalidInput(f"the archive has no file {name}")
            with archive.open(names[name.lower()]) as file:
                models[name] = _Model(file, name)
        return models[name]

    def parts(
        name: str, number: str, matrix: NDArray[np.float64], above: tuple[Any, ...]
    ) -> Iterator[Part]:
        if (name, number) in above:
            raise InvalidInput(f"object {number} is a part of itself")
        if number not in model(name).objects:
            raise InvalidInput(f"there is no object {number}")
        own = model(name).objects[number]
        yield Part(len(own.numbers) // 3, len(own.corners) // 3, own.made, matrix)
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
