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
from accuracy.limbed import BODIES
from accuracy.posing import posed
from accuracy.repeated import facade

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "python"))
from shapes import head, vertebra


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


if __name__ == "__main__":
    main(Path(sys.argv[1]))
