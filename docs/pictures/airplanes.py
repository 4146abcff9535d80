"""Lays what `symsurf demo` has drawn side by side: the first picture of README.

Usage: docs/pictures/airplanes.py DEMO, the folder that `symsurf demo -o DEMO` has written.
"""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

NAMES = ("one-side-cut-off", "one-side-cut-off-complete", "one-tip-raised")
SIZE = 480, 360
MADE = Path(__file__).parents[1] / "images" / "airplanes.png"


def main(folder: Path) -> None:
    strip = Image.new("RGB", (len(NAMES) * SIZE[0], SIZE[1]), "white")
    for column, name in enumerate(NAMES):
        picture = Image.open(folder / f"airplane-{name}.png").convert("RGB")
        strip.paste(picture.resize(SIZE, Image.Resampling.LANCZOS), (column * SIZE[0], 0))
    strip.quantize(256).save(MADE, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
