"""Takes the picture of docs/neighbours_partial.md.

python docs/pictures/partial.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

import symsurf

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
from accuracy import partial, scans

WIDE, MARGIN = 640, 15  # pixels
JOINED, MISSED = (0, 120, 60), (200, 30, 30)


def main(folder: Path) -> None:
    scan = scans.facade(np.random.default_rng(4))
    found = symsurf.partial_symmetries(scan.points, count=100).transformations
    low, size = scan.points[:, :2].min(axis=0), np.ptp(scan.points[:, :2], axis=0)
    unit = (WIDE - 2 * MARGIN) / size[0]
    high = int(unit * size[1]) + 2 * MARGIN

    def pixel(place: np.ndarray) -> tuple[float, float]:
        x, y = unit * (place[:2] - low)
        return MARGIN + x, high - MARGIN - y

    image = Image.new("RGB", (WIDE, high), "white")
    draw = ImageDraw.Draw(image)
    depth = scan.points[:, 2]
    grey = np.interp(depth, np.quantile(depth, (0.02, 0.98)), (70, 200)).astype(int)
    for point, shade in zip(scan.points, grey):
        x, y = pixel(point)
        draw.ellipse((x - 1, y - 1, x + 1, y + 1), fill=(shade,) * 3)
    one = scan.windows[len(scan.windows) // 2]
    for other in scan.windows:
        is_joined = partial.joins(found, one, other, scan.diagonal)
        draw.line((*pixel(one), *pixel(other)), fill=JOINED if is_joined else MISSED, width=5)
    image.save(folder / "partial_facade.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
