"""Cuts the pictures of docs/meshlab.md out of those that the test of MeshLab's window leaves.

make meshlab-gui && build/venv/bin/python docs/pictures/meshlab_window.py docs/images
"""

import sys
from pathlib import Path

from PIL import Image

PICTURES = Path(__file__).parents[2] / "build" / "meshlab-gui" / "pictures"
PARTS = {"menu": (0, 0, 960, 760), "dialog": (461, 71, 983, 748)}


def main(folder):
    for name, box in PARTS.items():
        image = Image.open(PICTURES / f"{name}.png").crop(box)
        image.save(folder / f"meshlab-{name}.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
