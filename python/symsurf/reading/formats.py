"""The formats that shapes are read from: what reads each, and what has to be installed for it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ..base import own_process
from ..base.options import Reading
from ..shapes import Shape
from .errors import broken

PACKED = ".gz"

# What a reader's own process may take: a packed mask unpacks to a thousand times its bytes, by zlib.
_MEMORY, _MEMORY_A_BYTE = 2 << 30, 1000
_SECONDS, _SECONDS_A_BYTE = 15, 1e-5


def limits_of(size: int) -> dict[str, Any]:
    """For a process of a reader: the memory and the time that a file of so many bytes may take."""
    return {
        "memory": _MEMORY + _MEMORY_A_BYTE * size,
        "seconds": _SECONDS + _SECONDS_A_BYTE * size,
    }


def read_by(module: str, what: str, path: Path, reading: Reading) -> Shape:
    """What a reader's module reads. Raises InvalidInput, InvalidParameter."""
    with broken(what):
        return import_module(module).read(path, reading)


def require_packages(what: str, packages: Iterable[str], extra: str) -> None:
    """Raises ImportError, naming what brings a package that is missing."""
    for package in packages:
        if find_spec(package) is None:
            raise ImportError(
                f"{what} needs the package {package}, which is not installed: pip install {extra}"
            )


@dataclass(frozen=True)
class Format:
    """A format, told by the suffix of a file's name."""

    suffix: str
    reader: str
    """The module of this package that has the function ``read``."""
    packages: tuple[str, ...] = ()
    """The modules to import, of optional packages."""
    extra: str = ""
    """Of symsurf, which brings them."""
    is_image: bool = False
    """Whether it may hold a mask or an image, of which a threshold or a label chooses the points."""
    unpacks: bool = False
    """Whether few bytes may stand for very many."""

    @property
    def name(self) -> str:
        return self.suffix[1:].upper()

    def require_packages(self) -> None:
        """Raises ImportError, naming the extra, without one."""
        require_packages(self.name, self.packages, f"'symsurf[{self.extra}]'")

    def read(self, path: Path, reading: Reading, size: int, is_packed: bool) -> Shape:
        """What the file holds. Where it is packed, or its reader is of others, it is read by a process of
        its own: a damaged one may end that, or take any memory and time.

        Args:
            size: of the file as it was given.
        """
        given = f"{__package__}.{self.reader}", self.name, path, reading
        if not (is_packed or self.unpacks or self.packages):
            return read_by(*given)
        return own_process.call(__name__, read_by.__name__, *given, **limits_of(size))


_CORE = (".ply", ".obj", ".off", ".stl", ".xyz", ".csv", ".txt", ".fcsv")

FORMATS: dict[str, Format] = {
    each.suffix: each
    for each in (
        *(Format(suffix, "own") for suffix in _CORE),
        Format(".glb", "gltf"),
        Format(".gltf", "gltf"),
        Format(".3mf", "threemf", unpacks=True),
        Format(".las", "las"),
        Format(".pcd", "pcd"),
        Format(".splat", "splat"),
        Format(".vtp", "vtk_data", ("pyvista",), "formats"),
        Format(".vtu", "vtk_data", ("pyvista",), "formats"),
        Format(".vtk", "vtk_data", ("pyvista",), "formats", is_image=True),
        Format(".vti", "vtk_data", ("pyvista",), "formats", is_image=True),
        Format(".laz", "laz", ("laspy", "lazrs"), "formats"),
        Format(".nrrd", "nrrd_image", ("nrrd",), "formats", is_image=True),
        Format(".nii", "nifti_image", ("nibabel",), "formats", is_image=True),
    )
}


def suffix_of(path: Path) -> str:
    """The suffix that tells the format, in small letters; of "a.PLY.gz" it is ".ply.gz"."""
    suffix = path.suffix.lower()
    return path.with_suffix("").suffix.lower() + PACKED if suffix == PACKED else suffix


def stem_of(path: Path) -> str:
    """The name without what tells the format, as "scan" of "scan.ply.gz"."""
    return Path(path.stem).stem if path.suffix.lower() == PACKED else path.stem


def format_of(suffix: str) -> Format | None:
    """The format of ".ply" or ".ply.gz"; None of others."""
    return FORMATS.get(suffix.removesuffix(PACKED))


def known_suffixes() -> str:
    """What can be read, in the words of an error."""
    groups: dict[str, list[str]] = {}
    for each in FORMATS.values():
        groups.setdefault(each.extra, []).append(each.suffix)
    texts = [
        f"with symsurf[{extra}] {' '.join(suffixes)}" if extra else " ".join(suffixes)
        for extra, suffixes in groups.items()
    ]
    return f"{', '.join(texts)}; each also as {PACKED}"


def known_names() -> str:
    """What can be read, in the words of a help text."""
    *names, last = [each.name for each in FORMATS.values()]
    return f"{', '.join(names)} or {last}, each also as {PACKED}"
