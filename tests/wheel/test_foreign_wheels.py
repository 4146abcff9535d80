"""The wheels of `make wheels` for other systems, in what runs their programs here: wine, qemu-user. Those for macOS are
looked at only."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MADE = ROOT / "build/wheels"
LONGEST = 300  # seconds: qemu translates every instruction

# What every Windows has, or its Python.
GRANTED = re.compile(
    r"(api-ms-win-crt-.*|kernel32|ntdll|advapi32|ws2_32|shell32|python3\d+)\.dll", re.IGNORECASE
)


def wheels(pattern: str) -> list[Path]:
    return sorted((MADE / "dist").glob(pattern))


def version(wheel: Path) -> str:
    return re.sub(r"cp3(\d+)", r"3.\1", wheel.name.split("-")[2])


def name(wheel: Path) -> str:
    return "-".join(wheel.name[:-4].split("-")[2:])


def install(wheel: Path, folder: Path, *platforms: str) -> Path:
    """Into a folder, as pip of that system does; with NumPy."""
    pip = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-index",
        "--find-links",
        MADE / "needs",
    ]
    kind = ["--only-binary", ":all:", "--implementation", "cp", "--python-version", version(wheel)]
    asked = [word for each in platforms for word in ("--platform", each)]
    subprocess.run(
        [*pip, *kind, *asked, "--target", folder, wheel], check=True, capture_output=True
    )
    return folder


def said_by(script: str, *command: object, site: Path, **variables: str) -> str:
    environment = os.environ | {"PYTHONPATH": str(site)} | variables
    done = subprocess.run(
        [str(each) for each in (*command, ROOT / "tests/wheel" / script)],
        env=environment, capture_output=True, text=True, timeout=LONGEST, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


SCRIPTS = {
    "first_mirror.py": "symsurf",
    "files_and_commands.py": "13 formats, processes and commands",
}


@pytest.mark.parametrize("script", SCRIPTS)
@pytest.mark.parametrize("wheel", wheels("*-win_amd64.whl"), ids=name)
def test_windows(wheel, script, tmp_path):
    if shutil.which("wine") is None:
        pytest.skip("wine is not installed")
    if version(wheel) in ("3.13", "3.14"):
        pytest.skip("NumPy 2 calls functions that Debian's wine lacks")
    site = install(wheel, tmp_path / "site", "win_amd64")
    python = MADE / "pythons/windows-x86_64" / version(wheel) / "python.exe"
    prefix = {"WINEPREFIX": str(MADE / "wine"), "WINEDEBUG": "-all"}
    windows_path = "Z:" + str(site).replace("/", "\\")
    assert SCRIPTS[script] in said_by(script, "wine", python, site=Path(windows_path), **prefix)


@pytest.mark.parametrize("wheel", wheels("*_aarch64.whl"), ids=name)
def test_first_mirror_on_arm(wheel, tmp_path):
    if shutil.which("qemu-aarch64") is None:
        pytest.skip("qemu-user is not installed")
    python = MADE / "pythons/linux-arm64" / version(wheel) / "bin" / f"python{version(wheel)}"
    if not python.exists():
        pytest.skip(f"no Python {version(wheel)} for aarch64 is here")
    site = install(wheel, tmp_path / "site", "manylinux_2_28_aarch64", "manylinux_2_17_aarch64")
    system = "/usr/aarch64-linux-gnu"
    libraries = ":".join(str(each) for each in (MADE / "zlib-arm64").glob("**/aarch64-linux-gnu"))
    setting = {"QEMU_SET_ENV": f"LD_LIBRARY_PATH={libraries}"}
    said = said_by("first_mirror.py", "qemu-aarch64", "-L", system, python, site=site, **setting)
    assert "symsurf" in said


@pytest.mark.parametrize("wheel", wheels("*.whl"), ids=name)
def test_files_are_those_of_its_system(wheel, tmp_path):
    archive = zipfile.ZipFile(wheel)
    names = archive.namelist()
    assert {"symsurf/py.typed", "symsurf/_core.pyi"} <= set(names)
    (module,) = (each for each in names if re.match(r"symsurf/_core\.[^/]*(so|pyd)$", each))
    magic = archive.read(module)[:4]
    system = wheel.name.split("-")[-1]
    expected = {"manylinux": b"\x7fELF", "win": b"MZ", "macosx": b"\xcf\xfa\xed\xfe"}
    (start,) = (value for key, value in expected.items() if system.startswith(key))
    assert magic.startswith(start)


@pytest.mark.parametrize("wheel", wheels("*manylinux*.whl"), ids=name)
def test_linux_wheels_need_no_newer_c_library_than_2_17(wheel):
    asked = re.findall(r"manylinux_2_(\d+)_", wheel.name)
    assert asked and min(map(int, asked)) <= 17


@pytest.mark.parametrize("wheel", wheels("*-win_amd64.whl"), ids=name)
def test_windows_modules_need_what_every_windows_has(wheel):
    archive = zipfile.ZipFile(wheel)
    (module,) = (each for each in archive.namelist() if each.endswith(".pyd"))
    said = subprocess.run(
        ["objdump", "--private-headers", "/dev/stdin"], input=archive.read(module),
        capture_output=True, check=False,
    ).stdout.decode()  # fmt: skip
    needed = re.findall(r"DLL Name: (\S+)", said)
    assert needed
    assert all(GRANTED.fullmatch(each) for each in needed), needed
