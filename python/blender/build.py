"""Builds the extension for Blender: a zip for each kind of Blender that a wheel of symsurf fits.

Usage: python3 python/blender/build.py WHEELS OUTPUT. WHEELS is a folder with wheels; those for other
versions of Python are left aside. Says which files it wrote.
"""

from __future__ import annotations

import re
import shutil
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).parent
SOURCE = HERE / "extension"
LICENCE = HERE.parents[1] / "meshlab_plugin/LICENSE"  # the GNU General Public License, version 3
# Of each Python the first Blender that has it, and the first that has it no more. Blender unpacks one
# wheel of a name, whatever Python it is for, so that each Python gets a zip of its own.
BLENDERS = {"cp311": ("4.2.0", "5.1.0"), "cp313": ("5.1.0", None)}
SYSTEMS = {"manylinux": "linux", "linux": "linux", "macosx": "macos", "win": "windows"}
MACHINES = {"x86_64": "x64", "amd64": "x64", "aarch64": "arm64", "arm64": "arm64"}


def platform_of(tag: str) -> str | None:
    """Blender's name of a wheel's platform, "linux-x64" of "manylinux_2_28_x86_64"; None for others."""
    found = re.match(r"(manylinux|linux|macosx|win)[\w.]*?_(x86_64|amd64|aarch64|arm64)$", tag)
    return f"{SYSTEMS[found[1]]}-{MACHINES[found[2]]}" if found else None


def stage(wheel: Path, folder: Path, platform: str) -> Path:
    """Lays out what the zip will hold, in a folder of its own, and gives that."""
    _, version, python, *_ = wheel.name.split("-")
    first, below = BLENDERS[python]
    made = folder / f"symsurf-{version}-blender-{first}-{platform.replace('-', '_')}"
    shutil.rmtree(made, ignore_errors=True)
    shutil.copytree(SOURCE, made, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(LICENCE, made)
    (made / "wheels").mkdir()
    shutil.copy(wheel, made / "wheels")
    manifest = made / "blender_manifest.toml"
    texts = {
        "@VERSION@": version,
        "@FIRST@": first,
        "@BELOW@\n": f'blender_version_max = "{below}"\n' if below else "",
        "@PLATFORMS@": f'["{platform}"]',
        "@WHEELS@": f'["./wheels/{wheel.name}"]',
    }
    text = manifest.read_text()
    for mark, value in texts.items():
        text = text.replace(mark, value)
    manifest.write_text(text)
    return made


def pack(staged: Path) -> Path:
    """The zip of a folder, beside it."""
    made = staged.parent / f"{staged.name}.zip"
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(each for each in staged.rglob("*") if each.is_file()):
            archive.write(path, path.relative_to(staged))
    return made


def build(wheels: Path, output: Path) -> list[Path]:
    """The zips of all wheels in a folder that a Blender can use."""
    output.mkdir(parents=True, exist_ok=True)
    made = []
    for wheel in sorted(wheels.glob("symsurf-*.whl")):
        python, platform = wheel.name.split("-")[2], platform_of(wheel.stem.split("-")[-1])
        if python in BLENDERS and platform:
            made.append(pack(stage(wheel, output, platform)))
    return made


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    zips = build(Path(sys.argv[1]), Path(sys.argv[2]))
    if not zips:
        sys.exit(f"{sys.argv[1]} has no wheel for Python {', '.join(BLENDERS)}")
    print(*zips, sep="\n")
