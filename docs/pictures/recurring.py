"""Takes the picture of docs/neighbours_recurring.md.

python docs/pictures/recurring.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import symsurf

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
from accuracy.repeated import facade, scanned

SIDE = 480  # pixels


def seen(points, instance):
    """From the front, a colour an instance; the depth as brightness."""
    hues = np.random.default_rng(5).integers(40, 255, size=(instance.max() + 2, 3))
    colours = np.where(instance[:, None] < 0, (185, 185, 185), hues[instance])
    low, size = points[:, :2].min(axis=0), np.ptp(points[:, :2], axis=0).max()
    column, row = ((SIDE - 6) * (points[:, :2] - low) / size).astype(int).T + 2
    image = np.full((SIDE, SIDE, 3), 255, np.uint8)
    near = np.argsort(points[:, 2])
    for right, down in ((0, 0), (0, 1), (1, 0), (1, 1)):
        image[SIDE - 2 - row[near] + down - 1, column[near] + right] = colours[near]
    return image


if __name__ == "__main__":
    rng = np.random.default_rng(2)
    mesh, faces, label = facade(4, 6, rng, cells=3)
    cloud, _ = scanned(mesh, faces, label, 60000, rng)
    noisy = mesh + 1e-3 * np.linalg.norm(np.ptp(mesh, axis=0)) * rng.normal(size=mesh.shape)
    panels = []
    for shape, own in ((cloud, None), (noisy, faces)):
        found = symsurf.recurring_parts(shape, faces=own)
        print([len(part) for part in found.parts])
        instance = found.arrays["instance"].astype(int)
        if own is not None:  # points of the faces, for the picture
            shape, instance = scanned(shape, own, instance, 60000, rng)
        panels.append(seen(shape, instance))
    Image.fromarray(np.hstack(panels)).save(Path(sys.argv[1]) / "recurring_scan.png", optimize=True)
