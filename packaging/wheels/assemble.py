"""Makes a wheel of a wheel: the same files, with a module that was compiled for another Python or system.

Usage: assemble.py WHEEL MODULE NAME TAG FOLDER, as in
    assemble.py symsurf-1.0.0-cp311-cp311-linux_x86_64.whl core_312.so _core.cpython-312-x86_64-linux-gnu.so \
        cp312-cp312-linux_x86_64 dist
"""

from __future__ import annotations

import base64
import hashlib
import re
import sys
import zipfile
from pathlib import Path


def main(wheel: Path, module: Path, name: str, tag: str, folder: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        files = {
            each: archive.read(each)
            for each in archive.namelist()
            if not re.fullmatch(r"symsurf/_core\..*\.so|.*\.dist-info/RECORD|.*/", each)
        }
    files[f"symsurf/{name}"] = module.read_bytes()
    (about,) = (each for each in files if each.endswith(".dist-info/WHEEL"))
    files[about] = re.sub(rb"(?m)^Tag: .*$", f"Tag: {tag}".encode(), files[about])
    distribution = "-".join(wheel.name.split("-")[:2])
    record = f"{distribution}.dist-info/RECORD"
    lines = [f"{each},sha256={digest(data)},{len(data)}" for each, data in files.items()]
    files[record] = "\n".join([*lines, f"{record},,", ""]).encode()
    made = folder / f"{distribution}-{tag}.whl"
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in files.items():
            entry = zipfile.ZipInfo(
                each, date_time=(1980, 1, 1, 0, 0, 0)
            )  # the same bits on any day
            entry.external_attr = (0o755 if each == f"symsurf/{name}" else 0o644) << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)
    print(made)


def digest(data: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], sys.argv[4], Path(sys.argv[5]))
