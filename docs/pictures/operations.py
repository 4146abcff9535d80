"""Takes the pictures of the operations' pages in docs/operations.

python docs/pictures/operations.py docs/images/operations
"""

import sys
from pathlib import Path

import numpy as np
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
    if "complete" in symsurf.operations():
        x, y, z = symmetric.points.T
        broken = without(symmetric, (x > 0.1) & (y < 0.3 + 0.2 * np.sin(5 * z)) & (z > -0.3))
        write(symsurf.complete(broken, plane), folder / "complete.png", front)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
