"""Packs what a release has for hosts, a zip each: what ParaView, MeshLab and 3D Slicer load as it is.

Usage: packaging/hosts.py BUILD OUTPUT packs the plugins for ParaView and MeshLab that lie in the folder BUILD, each
with the library that it needs beside it (by patchelf, on the path). packaging/hosts.py --slicer WHEELS OUTPUT packs the
module for 3D Slicer with each wheel that its Python can use. Says which files it wrote.
"""

from __future__ import annotations

import platform
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SLICER_PYTHON = "cp312"  # of Slicer 5.10 and later
VERSION = re.search(r"project\(symsurf VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
SYSTEM = f"linux_{platform.machine()}"


def with_libraries(plugin: Path, folder: Path) -> None:
    """Copies the plugin and what no host brings."""
    listed = subprocess.run(["ldd", plugin], capture_output=True, text=True, check=True).stdout
    (library,) = re.findall(r"libOpenMeshCore\S* => (\S+)", listed)
    for file in (plugin, Path(library)):
        copied = Path(shutil.copy(file, folder))
        copied.chmod(0o755)
        subprocess.run(["patchelf", "--set-rpath", "$ORIGIN", copied], check=True)


def pack(folder: Path, name: str, output: Path, licence: Path) -> Path:
    """The zip of a folder, with licences."""
    shutil.copy(licence, folder)
    shutil.copytree(ROOT / "licenses", folder / "licenses")
    return Path(shutil.make_archive(str(output / f"symsurf-{VERSION}-{name}"), "zip", folder))


def plugins(build: Path, output: Path) -> Iterator[Path]:
    found = {
        f"paraview-{each.parts[-4].partition('-')[2]}-{SYSTEM}": (each, ROOT / "LICENSE")
        for each in build.glob("paraview/lib/paraview-*/plugins/SymsurfPlugin/SymsurfPlugin.so")
    } | {
        f"meshlab-{each.parent.name}-{SYSTEM}": (each, ROOT / "meshlab_plugin/LICENSE")
        for each in build.glob("meshlab*/meshlab/*/filter_symsurf.so")
    }
    for name, (plugin, licence) in found.items():
        with tempfile.TemporaryDirectory() as folder:
            with_libraries(plugin, Path(folder))
            yield pack(Path(folder), name, output, licence)


def slicer_modules(wheels: Path, output: Path) -> Iterator[Path]:
    for wheel in sorted(wheels.glob(f"symsurf-{VERSION}-{SLICER_PYTHON}-*.whl")):
        system = wheel.stem.rpartition("-")[2].rpartition(".")[2]
        with tempfile.TemporaryDirectory() as folder:
            module = Path(folder) / "MirrorSymmetry"
            hidden = shutil.ignore_patterns("__pycache__", "CMakeLists.txt")
            shutil.copytree(ROOT / "python/slicer/MirrorSymmetry", module, ignore=hidden)
            (module / "Resources/wheels").mkdir(exist_ok=True)
            shutil.copy(wheel, module / "Resources/wheels")
            yield pack(Path(folder), f"slicer-{system}", output, ROOT / "LICENSE")


def main(words: list[str]) -> int:
    makes = slicer_modules if words[:1] == ["--slicer"] else plugins
    folders = [Path(word) for word in words if not word.startswith("--")]
    if len(folders) != 2:
        sys.exit(__doc__)
    folders[1].mkdir(parents=True, exist_ok=True)
    made = list(makes(*folders))
    for archive in made:
        print(archive, *zipfile.ZipFile(archive).namelist()[:3])
    return 0 if made else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
