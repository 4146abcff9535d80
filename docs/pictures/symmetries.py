"""Takes the pictures of the analyses' pages in docs/symmetries.

python docs/pictures/symmetries.py docs/images/symmetries
"""

import sys
from pathlib import Path

import pyvista
from PIL import Image

import symsurf


def nut():
    """Hexagonal, with a hexagonal hole."""
    ring = pyvista.Disc(inner=0.45, outer=1, r_res=1, c_res=6)
    return ring.extrude((0, 0, 0.6), capping=True).triangulate().clean()


def write(result, path, camera=None):
    result.plot(path, camera=camera)
    image = Image.open(path).convert("RGB").resize((640, 480), Image.Resampling.LANCZOS)
    image.save(path, optimize=True)


def main(folder):
    folder.mkdir(exist_ok=True)
    write(symsurf.symmetries(nut()), folder / "symmetries.png", (0.5, -1, 0.9))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
