"""Takes the picture of docs/neighbours_partial.md.

python docs/pictures/partial.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import symsurf

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
from accuracy import scans


def main(folder):
    scan = scans.facade(np.random.default_rng(4))
    path = folder / "partial_facade.png"
    symsurf.partial_symmetries(scan.points).plot(path, camera=(0.2, -0.4, 1))
    image = Image.open(path).convert("RGB").resize((640, 480), Image.Resampling.LANCZOS)
    image.save(path, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
