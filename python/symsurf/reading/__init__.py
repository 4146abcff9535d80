"""Reading shapes, each format in its own module. What can be read is in ``formats``."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import BinaryIO, cast

from .._core import InvalidInput, InvalidParameter
from ..base.options import Reading, documented, part
from ..shapes import Shape
from ..shapes.shape import SourceFile
from .errors import broken, naming
from .formats import format_of, known_names, known_suffixes, stem_of, suffix_of
from .location import located

__all__ = ["files_in", "known_names", "read", "require_format", "stem_of", "suffix_of"]


@documented
def read(
    path: str | os.PathLike[str] | BinaryIO,
    format: str | None = None,
    *,
    threshold: float | None = None,
    label: int | str | None = None,
    scalars: str | None = None,
    external_files: bool = False,
) -> Shape:
    """Reads a mesh, a cloud, or the points of a mask.

    PLY, OBJ, OFF, STL, XYZ, CSV, TXT, FCSV, GLB, GLTF, 3MF, LAS, PCD and SPLAT; with
    ``symsurf[formats]`` VTP, VTU, VTK, VTI, LAZ, NRRD and NIfTI (NII); each also compressed, as
    ``.ply.gz``. Coordinates keep every digit a double holds, in the unit and the axes of the file. Of
    masks and images they are the centres of voxels in world coordinates: RAS of NIfTI, the header's space
    (LPS of 3D Slicer) of NRRD.

    Args:
        path: the name of a file, or a binary file that is open.
        format: "ply", "ply.gz", ...; without it the name's suffix tells. A file that is open
            needs it.
        {Reading}

    Raises:
        InvalidInput: names the file and the reason: unknown suffix, an optional package that is not
            installed, not readable, larger than half of the memory, broken, truncated, no points.
        InvalidParameter: an unknown format; a threshold or a label for what is no image.
    """
    reading = Reading(**part(Reading, locals()))
    suffix = None if format is None else require_format(format)
    if hasattr(path, "read"):
        if suffix is None:
            raise InvalidParameter("format is None; an open file needs one, such as 'ply'")
        stream = cast(BinaryIO, path)
        return _read(str(getattr(stream, "name", "the open file")), suffix, stream, reading)
    if not isinstance(path, (str, bytes, os.PathLike)) or "\0" in os.fsdecode(path):
        raise InvalidInput(f"path is {path!r}; allowed is the name of a file")
    name = os.fsdecode(path)
    _require_no_folder(name)
    return _read(name, suffix or suffix_of(Path(name)), None, reading)


def require_format(name: object) -> str:
    """The suffix of a format's name, as ".ply.gz" of "ply.gz". Raises InvalidParameter."""
    suffix = f".{name.lower().removeprefix('.')}" if isinstance(name, str) else ""
    if format_of(suffix) is None:
        allowed = known_suffixes().replace(" .", " ").removeprefix(".")
        raise InvalidParameter(f"format is {name!r}; allowed are {allowed}")
    return suffix


def files_in(paths: Iterable[Path]) -> list[Path]:
    """The paths, with the files of known suffixes, by name, in place of a folder; not those of the
    folders in it. A folder without any stays."""
    return [file for path in paths for file in _readable_in(path) or [path]]


def _readable_in(folder: Path) -> list[Path]:
    """Nothing of what is no folder, or may not be looked into."""
    try:
        return sorted(file for file in folder.iterdir() if _is_readable(file))
    except OSError:
        return []


def _is_readable(file: Path) -> bool:
    return format_of(suffix_of(file)) is not None and file.is_file()


def _require_no_folder(name: str) -> None:
    if os.path.isdir(name):
        count = len(_readable_in(Path(name)))
        raise InvalidInput(
            f"{name}: this is not a file but a folder, with {count} that can be read"
        )


def _read(name: str, suffix: str, stream: BinaryIO | None, reading: Reading) -> Shape:
    described = format_of(suffix)
    if described is None:
        raise InvalidInput(f"{name}: suffix '{suffix}' is none of {known_suffixes()}")
    for option, value in reading.of_image().items():
        if not described.is_image:
            raise InvalidParameter(
                f"{option} is {value!r}; allowed is None, as {name} is {described.name}, no image"
            )
    with naming(name):
        try:
            described.require_packages()
        except ImportError as error:
            raise InvalidInput(str(error)) from error
        with broken(described.name):
            with located(name, suffix, stream) as file:
                is_packed = stream is None and suffix != described.suffix
                size = os.path.getsize(name) if is_packed else file.stat().st_size
                shape = described.read(file.absolute(), reading, size, suffix != described.suffix)
            _require_sound(shape)
    content = stream.getvalue() if isinstance(stream, BytesIO) else None
    is_file = stream is None or content is not None
    return replace(
        shape, source=SourceFile(Path(name).absolute(), suffix, content) if is_file else None
    )


def _require_sound(shape: Shape) -> None:
    if not len(shape.points):
        raise InvalidInput("there are no points")
    if shape.faces is not None and len(shape.faces):
        outside = shape.faces[(shape.faces < 0) | (shape.faces >= len(shape.points))]
        if len(outside):
            raise InvalidInput(
                f"a face names point {outside[0]}; there are {len(shape.points)} points"
            )
