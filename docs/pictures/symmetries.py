"""Takes the pictures of the analyses' pages in docs/symmetries.

python docs/pictures/symmetries.py docs/images/symmetries
"""

import sys
from pathlib import Path

import numpy as np
import pyvista
from PIL import Image

import symsurf
from symsurf import Shape

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
from accuracy.coloured_parts import COLOURED_PARTS
from accuracy.helical import polygon, turned
from accuracy.limbed import BODIES
from accuracy.posing import posed
from accuracy.repeated import facade

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "python"))
from shapes import _rod, head, vertebra


def nut():
    """Hexagonal, with a hexagonal hole."""
    ring = pyvista.Disc(inner=0.45, outer=1, r_res=1, c_res=6)
    return ring.extrude((0, 0, 0.6), capping=True).triangulate().clean()


def twins_and_another():
    """Two heads, one of them turned, and a vertebra."""
    one, other = head(4), vertebra(40)
    turned = symsurf.synthetic.rotate(one.points, 10, 35, 70) + (3, 0.4, 0)
    apart = (other.points - other.points.mean(axis=0)) / np.ptp(other.points) * 2.5 + (1.5, 2.6, 0)
    count = len(one.points)
    faces = [one.faces, one.faces + count, other.faces + 2 * count]
    return Shape(np.vstack([one.points, turned, apart]), np.vstack(faces))


def cube(cells=6):
    """The points of a grid on the surface of a cube."""
    steps = np.linspace(-1, 1, cells + 1)
    grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    return grid[np.abs(grid).max(axis=1) == 1]


def upright_facade():
    points, faces, _ = facade(4, 6, np.random.default_rng(0), cells=4)
    return symsurf.recurring_parts(points[:, [0, 2, 1]] * (1, -1, 1), faces=faces)


def labelled_bottle():
    points, faces, colours = COLOURED_PARTS["bottle with a label"].mesh(edge=0.02)
    return symsurf.symmetries(points, faces=faces, colours=colours, texture=True)


def bolt(pitch=0.25):
    """A thread, a shank and a hexagonal head, along the x axis."""

    def thread(angle, z):
        return 0.5 - 0.5 * pitch * np.abs(2 * ((z / pitch - angle / (2 * np.pi)) % 1) - 1)

    mesh = turned(thread, 0, 2, 160)
    mesh += turned(lambda angle, z: 0.5 + 0 * z, 2, 2.6, 30)
    mesh += turned(lambda angle, z: 0.95 * polygon(6, angle), 2.6, 3.2, 20, 96)
    return Shape(mesh.points[:, [2, 0, 1]], mesh.faces)


def bone(cells=90):
    """A shaft with a head on a neck, a trochanter and two condyles."""
    low, high = np.array([-0.5, -0.5, -1.4]), np.array([0.6, 0.5, 1.5])
    axes = [np.linspace(*ends, cells) for ends in zip(low, high, strict=True)]
    x = np.meshgrid(*axes, indexing="ij")
    rods = [((0, 0, -1), (0.03, 0.08, 0), 0.1), ((0.03, 0.08, 0), (0, 0, 0.9), 0.1),
            ((0, 0, 0.9), (0.25, 0.08, 1.1), 0.13), ((0.25, 0.08, 1.1), (0.27, 0.09, 1.12), 0.18),
            ((0, 0, 0.9), (-0.13, -0.06, 0.97), 0.14), ((0, 0, -1), (0.16, -0.06, -1.04), 0.16),
            ((0, 0, -1), (-0.14, -0.1, -1.0), 0.13)]  # fmt: skip
    field = np.min([_rod(x, *rod) for rod in rods], axis=0)
    grid = pyvista.ImageData(dimensions=field.shape, origin=low, spacing=(high - low) / (cells - 1))
    return grid.contour([0.0], scalars=field.ravel(order="F")).triangulate().clean()


def write_pair(path):
    """A left and a right bone, of which the head is missing, and the left one laid onto the right."""
    left = bone()
    right = left.reflect((1, 0, 0)).clip("z", origin=(0, 0, 0.95)).triangulate()
    right = right.rotate_y(35).rotate_z(20).translate((1.6, 0, 0))
    found = symsurf.match_pair(left, right)
    plotter = pyvista.Plotter(off_screen=True, window_size=(1280, 960))
    plotter.add_mesh(left, color="#d8b08c", smooth_shading=True)
    plotter.add_mesh(right, color="#7fa7c9", smooth_shading=True)
    plotter.add_mesh(right.translate((1.8, 0, 0)), color="#7fa7c9", smooth_shading=True)
    image = left.transform(found.matrix, inplace=False).translate((1.8, 0, 0))
    plotter.add_mesh(image, color="#d8b08c", opacity=0.45, smooth_shading=True)
    plotter.view_xz()
    plotter.camera.zoom(1.6)
    plotter.screenshot(path)
    image = Image.open(path).convert("RGB").resize((640, 480), Image.Resampling.LANCZOS)
    image.save(path, optimize=True)


def write(result, path, camera=None):
    result.plot(path, camera=camera)
    image = Image.open(path).convert("RGB").resize((640, 480), Image.Resampling.LANCZOS)
    image.save(path, optimize=True)


def main(folder):
    folder.mkdir(exist_ok=True)
    above = (0.5, -1, 0.9)
    write(symsurf.symmetries(nut()), folder / "symmetries.png", above)
    write(labelled_bottle(), folder / "texture.png", (1, -0.5, 0.4))
    write(
        symsurf.partial_symmetries(twins_and_another()),
        folder / "partial_symmetries.png",
        (0, -0.3, 1),
    )
    write(upright_facade(), folder / "recurring_parts.png", (0.3, -1, 0.2))
    write(symsurf.symmetry_embedding(cube()), folder / "symmetry_embedding.png", above)
    body = BODIES["animal"]
    points = posed(body, np.random.default_rng(1), 0.9)
    write(symsurf.intrinsic_symmetry(points, faces=body.faces), folder / "intrinsic_symmetry.png")
    write(symsurf.helical_symmetry(bolt()), folder / "helical_symmetry.png", (0.3, -1, 0.4))
    write_pair(folder / "match_pair.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
