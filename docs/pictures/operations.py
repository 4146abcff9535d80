"""Takes the pictures of the operations' pages in docs/operations.

python docs/pictures/operations.py docs/images/operations
"""

import sys
from pathlib import Path

import numpy as np
import pyvista
from PIL import Image
from pyvista import examples

import symsurf
from symsurf import Shape, synthetic

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "python"))
from shapes import bent, dented, head, without

ANGLES = (20, -25, 35)  # degrees


def turned(shape):
    return Shape(synthetic.rotate(shape.points, *ANGLES) + (3, 1, 2), shape.faces)


def ant():
    """PyVista's, its length along z, mirrored by x = 0."""
    mesh = symsurf.read(Path(examples.antfile))
    shorter, longer = sorted((1, 2), key=lambda axis: np.ptp(mesh.points[:, axis]))
    points = mesh.points[:, [0, shorter, longer]]
    return Shape(points - (points.min(axis=0) + points.max(axis=0)) / 2, mesh.faces)


def broken_pot():
    """A vessel with 40 % of its turn missing."""
    height = np.linspace(0, 1, 90)
    radius = 0.32 + 0.16 * np.sin(2.9 * height + 0.1) - 0.16 * height**6
    radius += 0.1 * np.clip(height - 0.92, 0, 1)
    angle = np.linspace(0, 2 * np.pi, 181)[:-1]
    r, z = radius[:, None], height[:, None] + 0 * angle
    points = np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=2).reshape(-1, 3)
    index = np.arange(len(points)).reshape(len(height), len(angle))
    a, c = index[:-1], index[1:]
    b, d = np.roll(a, -1, axis=1), np.roll(c, -1, axis=1)
    faces = np.concatenate([np.stack(f, -1).reshape(-1, 3) for f in ((a, b, d), (a, d, c))])
    turn = np.arctan2(points[:, 1], points[:, 0]) + 0.25 * np.sin(9 * points[:, 2])
    return without(Shape(points, faces), np.abs(turn) > 0.6 * np.pi)


def write(result, path, camera=None):
    result.plot(path, camera=camera)
    image = Image.open(path).convert("RGB").resize((640, 480), Image.Resampling.LANCZOS)
    image.save(path, optimize=True)


def main(folder):
    front = (0.45, -1, 0.25)
    symmetric = head()
    hurt = dented(symmetric, (0.45, -0.55, -0.15), 0.3, 0.08)
    plane = symsurf.detect_plane(hurt).mirror
    write(symsurf.asymmetry(hurt, plane), folder / "asymmetry.png", front)
    write(symsurf.symmetrize(hurt, plane, side="negative"), folder / "symmetrize.png", front)
    write(symsurf.correspondences(head(4), plane), folder / "correspondences.png", (0, -1, 0.35))
    up, towards = synthetic.rotate(np.array([(0.0, 0, 1), (0, -1, 0)]), *ANGLES)
    aligned = symsurf.align(turned(hurt), up=up, front=towards, frame="blender")
    write(aligned, folder / "align.png")
    above = (0.3, 1, 0.5)
    write(
        symsurf.straighten(bent(ant(), 0.7 * np.ptp(ant().points[:, 2]))),
        folder / "straighten.png",
        above,
    )
    even = symsurf.remesh(symmetric, plane, edge_length=0.025)
    write(even, folder / "remesh.png", front)
    write(symsurf.cut(symmetric, plane), folder / "cut.png", (-1, -0.6, 0.3))
    stripes = np.where(symmetric.points[:, 0] > 0, np.sin(25 * symmetric.points[:, 2]), 0)
    side = "positive" if plane.normal[0] > 0 else "negative"
    painted = symsurf.transfer(stripes, symmetric, plane, side=side)
    write(painted, folder / "transfer.png", front)
    square = pyvista.Plane(i_size=1.8, j_size=1.8, i_resolution=300, j_resolution=300)
    screen = square.translate((-0.5, 0.3, 1.3)).triangulate()
    numbers = symsurf.Quadric(np.diag([0.34, 0.2, 0]), (0, 0, -1), 0).numbers
    x, y, _ = 1.2 * square.points.T
    bowl = symsurf.make_mirror("quadric", numbers, np.stack([x, y, 0.34 * x**2 + 0.2 * y**2], 1))
    lit = symsurf.illuminate(screen, bowl, light=(0.7, -0.5, 2.3))
    write(lit, folder / "illuminate.png", (-0.4, -1, 0.5))
    if "complete" in symsurf.operations():
        x, y, z = symmetric.points.T
        broken = without(symmetric, (x > 0.1) & (y < 0.3 + 0.2 * np.sin(5 * z)) & (z > -0.3))
        write(symsurf.complete(broken, plane), folder / "complete.png", front)
        pot = symsurf.complete(broken_pot(), symmetry="axis")
        write(pot, folder / "complete_pot.png", (-1, 0.9, 0.45))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
