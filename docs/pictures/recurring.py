"""Takes the picture of docs/neighbours_recurring.md.

python docs/pictures/recurring.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
import pyvista

import symsurf

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
from accuracy.repeated import facade

if __name__ == "__main__":
    rng = np.random.default_rng(2)
    points, faces, _ = facade(4, 6, rng, cells=3)
    points += 1e-3 * np.linalg.norm(np.ptp(points, axis=0)) * rng.normal(size=points.shape)
    found = symsurf.recurring_parts(points, faces=faces)
    print([len(part) for part in found.parts])
    instance = found.arrays["instance"].astype(int)
    hues = rng.integers(40, 255, size=(instance.max() + 2, 3))
    mesh = pyvista.make_tri_mesh(points, faces)
    mesh["colours"] = np.where(instance[:, None] < 0, 185, hues[instance]).astype(np.uint8)
    plotter = pyvista.Plotter(off_screen=True, window_size=(960, 600))
    plotter.set_background("white")
    plotter.add_mesh(mesh, scalars="colours", rgb=True, lighting=True)
    plotter.view_xy()
    plotter.camera.zoom(1.05)
    plotter.screenshot(Path(sys.argv[1]) / "recurring_noise.png")
