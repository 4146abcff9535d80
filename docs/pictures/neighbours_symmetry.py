"""Takes the pictures of docs/neighbours_symmetry.md.

python docs/pictures/neighbours_symmetry.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import symsurf
from symsurf.plotting.drawing import new_plotter

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
from accuracy.embedding import sampled_orbits
from accuracy.intrinsic import incomplete_scan
from accuracy.limbed import BODIES
from accuracy.posing import posed

SIZE = (480, 400)


def shades(values):
    """(n, 3) numbers as colours."""
    low, high = np.quantile(values, (0.02, 0.98), axis=0)
    return (255 * np.clip((values - low) / (high - low), 0, 1)).astype(np.uint8)


def panel(points, camera, **style):
    plotter = new_plotter(off_screen=True, window_size=SIZE)
    plotter.add_points(points, render_points_as_spheres=True, show_scalar_bar=False, **style)
    plotter.view_vector(camera, (0, 0, 1))
    plotter.camera.zoom(1.1)
    return plotter.screenshot(return_img=True)


def save(path, *panels):
    Image.fromarray(np.hstack(panels)).save(path, optimize=True)


def alike(name, missing, seed, camera):
    """A point and its image have the same colour: that of the middle between them."""
    rng = np.random.default_rng(seed)
    body = BODIES[name]
    scan, _, _ = incomplete_scan(body, posed(body, rng, 0.9), missing, rng)
    images = symsurf.intrinsic_symmetry(scan).image
    there = np.where((images >= 0)[:, None], scan[images], scan)
    return panel(scan, camera, scalars=shades(scan + there), rgb=True, point_size=4)


def distances(name, seed, camera):
    """From one point: blue where it is near."""
    points, _ = sampled_orbits(name, 20_000, np.random.default_rng(seed))
    found = symsurf.symmetry_embedding(points, localization=0.1, power=2).embedding
    top = points[:, 0].argmax()
    away = np.linalg.norm(found - found[top], axis=1)
    return panel(points, camera, scalars=away, cmap="viridis", point_size=5)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    save(folder / "neighbours_intrinsic.png", alike("animal", 0, 1, (1, -1, 0.6)),
         alike("person", 0.1, 2, (0.4, -1, 0.3)))  # fmt: skip
    save(folder / "neighbours_embedding.png",
         *(distances(name, 4, (0.2, 0.5, 1)) for name in ("mirror", "five-fold, mirrors")))  # fmt: skip
