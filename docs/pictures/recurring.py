"""Takes the pictures of docs/neighbours_recurring.md.

python docs/pictures/recurring.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
import pyvista

import symsurf

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
from accuracy.repeated import facade
from accuracy.solids import sampled


def show(found: symsurf.RecurringParts, data: pyvista.PolyData, path: Path) -> None:
    """Each instance in a colour of its own."""
    print([len(part) for part in found.parts])
    rng = np.random.default_rng(2)
    instance = found.arrays["instance"].astype(int)
    hues = rng.integers(40, 255, size=(instance.max() + 2, 3))
    data["colours"] = np.where(instance[:, None] < 0, 185, hues[instance]).astype(np.uint8)
    plotter = pyvista.Plotter(off_screen=True, window_size=(960, 600))
    plotter.set_background("white")
    plotter.add_mesh(data, scalars="colours", rgb=True, lighting=True, point_size=2)
    plotter.view_vector((0.35, 0.25, 1), viewup=(0, 1, 0))
    plotter.camera.zoom(1.1)
    plotter.screenshot(path)
    plotter.close()


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    rng = np.random.default_rng(2)
    points, faces, _ = facade(4, 6, rng, cells=3)
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    noisy = points + 1e-3 * diagonal * rng.normal(size=points.shape)
    found = symsurf.recurring_parts(noisy, faces=faces)
    show(found, pyvista.make_tri_mesh(noisy, faces), folder / "recurring_noise.png")
    cloud = sampled(points, faces, 100_000, rng)
    cloud += 5e-4 * diagonal * rng.normal(size=cloud.shape)
    found = symsurf.recurring_parts(cloud)
    show(found, pyvista.PolyData(cloud), folder / "recurring_cloud.png")
