"""Takes the picture of docs/curved_benchmark.md.

python docs/pictures/curved_benchmark.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from symsurf.plotting import INK, new_plotter
from symsurf.synthetic import benchmark

SHAPES = ("creature", "head", "part", "mask", "sheets")
BENDS = ("straight", "bent", "domed", "waved", "twisted")
SEED = 0


def view_of(sample):
    """The points in a frame of their own: a point's way to its image lies in the picture, in the
    mean, and their longest extent across it as well."""
    points = (sample.points - sample.points.mean(axis=0)) / sample.diagonal
    chords = sample.images - sample.points
    across = np.linalg.svd(chords, full_matrices=False)[2][0]
    flat = points - np.outer(points @ across, across)
    longest = np.linalg.svd(flat, full_matrices=False)[2][0]
    return points @ np.column_stack([longest, across, np.cross(longest, across)])


def main(folder):
    plotter = new_plotter(
        True, shape=(len(SHAPES), len(BENDS)), window_size=(1400, 1100), border=False
    )
    names = [f"{shape}-{bend}-exact" for shape in SHAPES for bend in BENDS]
    for number, sample in enumerate(benchmark("medium", SEED, names)):
        plotter.subplot(*divmod(number, len(BENDS)))
        half = np.linalg.norm(sample.images - sample.points, axis=1)
        plotter.add_points(
            view_of(sample), scalars=half, cmap="viridis", point_size=3, show_scalar_bar=False
        )
        title = f"{sample.shape}, {sample.bend}"
        plotter.add_text(title, position="lower_edge", font_size=8, color=INK)
        plotter.view_vector((0.1, -0.25, 1))
        plotter.camera.zoom(1.4)
    image = Image.fromarray(plotter.screenshot(return_img=True))
    image.quantize(64).save(folder / "curved_benchmark.png", optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
