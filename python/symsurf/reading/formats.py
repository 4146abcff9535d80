"""The formats that shapes are read from: what reads each, and what has to be installed for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from ..base.own_process import call
from ..shapes import Choice, Shape

PACKED = ".gz"

Reader = Callable[[Path, Choice], Shape]


# What a reader's own process may take: a packed mask unpacks to a thousand times its bytes, by zlib.
_MEMORY, _MEMORY_A_BYTE = 2 << 30, 1000
_SECONDS, _SECONDS_A_BYTE = 60, 1e-5


def _elsewhere(module: str, path: Path, choice: Choice) -> Shape:
    size = path.stat().st_size
    return call(
        module,
        "read",
        path,
        choice,
        memory=_MEMORY + _MEMORY_A_BYTE * size,
        seconds=_SECONDS + _SECONDS_A_BYTE * size,
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
    may_die: bool = False
    """Whether a damaged file may end the process of its reader, which then has one of its own."""

    @property
    def name(self) -> str:
        return self.suffix[1:].upper()

    def load(self) -> Reader:
        """The function that reads it. Raises ImportError, naming the extra, without a package."""
        for package in self.packages:
            if find_spec(package) is None:
                raise ImportError(
                    f"{self.name} needs the package {package}, which is not installed: "
                    f"pip install 'symsurf[{self.extra}]'"
                )
        module = f"{__package__}.{self.reader}"
        return partial(_elsewhere, module) if self.may_die else import_module(module).read


_CORE = (".ply", ".obj", ".off", ".stl", ".xyz", ".csv", ".txt", ".fcsv")

FORMATS: dict[str, Format] = {
    each.suffix: each
    for each in (
        *(Format(suffix, "own") for suffix in _CORE),
        Format(".glb", "gltf"),
        Format(".gltf", "gltf"),
        Format(".3mf", "threemf"),
        Format(".las", "las"),
        Format(".pcd", "pcd"),
        Format(".vtp", "vtk_data", ("pyvista",), "formats", may_die=True),
        Format(".vtu", "vtk_data", ("pyvista",), "formats", may_die=True),
        Format(".vtk", "vtk_data", ("pyvista",), "formats", is_image=True, may_die=True),
        Format(".vti", "vtk_data", ("pyvista",), "formats", is_image=True, may_die=True),
        Format(".laz", "laz", ("laspy", "lazrs"), "formats", may_die=True),
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
