"""The list of mechanisms, and a copy of the sources in which each can be switched off."""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import tomllib

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build" / "ablation"
VARIABLE = "SYMSURF_WITHOUT"
"""Names of the mechanisms that are off, joined by semicolons."""

ASKS = f"""
#include <cstdlib>
#include <cstring>
inline bool without(const char* name) {{
  static const char* const off = std::getenv("{VARIABLE}");
  const std::size_t length = std::strlen(name);
  for (const char* at = off; at && (at = std::strstr(at, name)); at += length)
    if ((at == off || at[-1] == ';') && (at[length] == ';' || !at[length])) return true;
  return false;
}}
"""
EVERYWHERE = Path("core/include/symsurf/points.h")
"""The header that gets the function: all sources include it."""


@dataclass(frozen=True)
class Mechanism:
    name: str
    file: str
    find: str
    """Occurs once in the file."""
    replace: str
    cases: tuple[str, ...] = ()
    """Texts of the names of accuracy cases."""
    subjects: tuple[str, ...] = ("",)
    seeds: int = 2

    def occurrences(self) -> int:
        return (ROOT / self.file).read_text().count(self.find)


def mechanisms() -> list[Mechanism]:
    with (Path(__file__).parent / "mechanisms.toml").open("rb") as file:
        listed = tomllib.load(file)["mechanism"]
    return [Mechanism(**{k: tuple(v) if isinstance(v, list) else v for k, v in each.items()})
            for each in listed]  # fmt: skip


def build(all_mechanisms: list[Mechanism]) -> Path:
    """Builds the Python module in which they can be switched off, and gives its folder."""
    source, made = BUILD / "source", BUILD / "build"
    changed: dict[Path, str] = {EVERYWHERE: (ROOT / EVERYWHERE).read_text() + ASKS}
    for each in all_mechanisms:
        file = Path(each.file)
        text = changed.get(file) or (ROOT / file).read_text()
        if text.count(each.find) != 1:
            raise SystemExit(
                f"{each.name}: its text occurs {text.count(each.find)} times in {file}"
            )
        changed[file] = text.replace(each.find, each.replace)
    present = {Path("CMakeLists.txt")}
    for folder in ("core", "python"):
        present |= {p.relative_to(ROOT) for p in (ROOT / folder).rglob("*") if p.is_file()}
    for file in present:
        if file.suffix == ".pyc":
            continue
        content = changed[file].encode() if file in changed else (ROOT / file).read_bytes()
        copy = source / file
        if not copy.exists() or copy.read_bytes() != content:  # what is the same is not built again
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(content)
    for copy in [*(source / "core").rglob("*"), *(source / "python").rglob("*")]:
        if copy.is_file() and copy.relative_to(source) not in present:
            copy.unlink()
    pybind11 = subprocess.check_output([sys.executable, "-m", "pybind11", "--cmakedir"], text=True)
    _run("cmake", "-S", source, "-B", made, "-G", "Ninja", "-DSYMSURF_PYTHON=ON",
         f"-DPython_EXECUTABLE={sys.executable}", f"-Dpybind11_DIR={pybind11.strip()}")  # fmt: skip
    _run("cmake", "--build", made, "--target", "symsurf_python")
    shutil.copytree(source / "python/symsurf", made / "python/symsurf", dirs_exist_ok=True)
    return made / "python"


def _run(*command: object) -> None:
    done = subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(done.stdout[-4000:] + done.stderr)
