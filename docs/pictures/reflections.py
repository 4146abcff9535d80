"""Takes the picture of docs/optics.md.

python docs/pictures/reflections.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
import pyvista
from PIL import Image

import symsurf
from symsurf.plotting import INK, new_plotter

LAMP, EYE = np.array([-1.0, 0.6, 2.5]), np.array([0.32, -1.33, 1.5])
SCREEN = 1.5  # height of what the mirror lights up


def wavy_mirror():
    """Low waves, over a square: the quadratic patches of a free form."""
    x, y = (each.ravel() for each in np.meshgrid(*2 * [np.linspace(-2.7, 2.7, 28)]))
    height = x * 0
    slopes, bends = np.zeros((len(x), 2)), np.zeros((len(x), 3))
    for size, a, b, phase in ((0.05, 2.4, 2.1, 0.5), (0.05, 2.4, -2.1, 0.5), (0.04, 1, 2.6, 0)):
        angle = a * x + b * y + phase
        height += size * np.sin(angle)
        slopes += size * np.cos(angle)[:, None] * (a, b)
        bends -= size * np.sin(angle)[:, None] * (a * a / 2, a * b, b * b / 2)
    rows = np.ones((len(x), 1))
    numbers = {"centres": np.column_stack([x, y, height]), "tangents": rows * (1, 0, 0),
               "normals": rows * (0, 0, 1), "radii": 0.45 * rows,
               "heights": np.column_stack([0 * x, slopes, bends])}  # fmt: skip
    return symsurf.make_mirror("free-form", numbers)


def add_mirror(plotter, mirror):
    vertices, triangles = mirror.mesh(mirror.centres, resolution=80)
    plotter.add_mesh(
        pyvista.PolyData.from_regular_faces(vertices, triangles),
        color="#9ec9c1",
        smooth_shading=True,
        specular=0.4,
    )


def main(folder):
    mirror = wavy_mirror()
    plotter = new_plotter(True, shape=(1, 2), window_size=(1100, 480), border=False)
    add_mirror(plotter, mirror)
    found = mirror.reflection_points(LAMP, EYE)
    for x in found.positions:
        plotter.add_lines(np.array([LAMP, x, x, EYE]), color=INK, width=2)
    plotter.add_points(found.positions, color=INK, point_size=12, render_points_as_spheres=True)
    for point, colour in ((LAMP, "#e0a100"), (EYE, "#3465a4")):
        plotter.add_points(
            point[None], color=colour, ambient=0.5, point_size=22, render_points_as_spheres=True
        )
    plotter.add_text(f"{len(found)} points of reflection", position="lower_edge", font_size=9,
                     color=INK)  # fmt: skip
    plotter.view_vector((0.35, -1, 0.55))
    plotter.camera.zoom(1.25)

    plotter.subplot(0, 1)
    count = 160
    x, y = np.meshgrid(*2 * [np.linspace(-2.5, 2.5, count)], indexing="ij")
    lit = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, SCREEN)])
    # Light takes its way in both directions: what the source gives to each point of the screen.
    light = mirror.reflection_points(lit, LAMP)
    brightness = np.bincount(light.sources, light.irradiance, minlength=len(lit))
    screen = pyvista.StructuredGrid(x, y, np.full_like(x, SCREEN))
    screen["irradiance"] = np.log10(np.clip(brightness, 1e-2, 2)).reshape(x.shape).ravel(order="F")
    plotter.add_mesh(screen, cmap="gray", lighting=False, show_scalar_bar=False)
    plotter.add_text("what it throws on the plane z = 1.5: caustics", position="lower_edge",
                     font_size=9, color=INK)  # fmt: skip
    plotter.view_xy()
    plotter.camera.zoom(1.2)
    image = Image.fromarray(plotter.screenshot(return_img=True))
    image.save(folder / "reflections.png", optimize=True)
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
