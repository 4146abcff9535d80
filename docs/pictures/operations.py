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

BUMPS = np.array([  # of a head: direction, width, height; each at both sides of x = 0
    [0.0, -0.97, 0.05, 0.16, 0.22],  # nose
    [0.34, -0.87, 0.28, 0.17, -0.14],  # eyes
    [0.30, -0.85, 0.52, 0.2, 0.06],  # brows
    [0.0, -0.85, -0.52, 0.2, 0.10],  # chin
    [0.16, -0.92, -0.28, 0.12, 0.03],  # lips
    [0.97, 0.12, 0.05, 0.15, 0.20],  # ears
    [0.0, 0.75, 0.35, 0.6, 0.15],  # back of the head
])  # fmt: skip


def head(nsub=6):
    """Exactly symmetric about x = 0, looking along -y."""
    mesh = pyvista.Icosphere(radius=1, nsub=nsub)
    x = np.array(mesh.points, dtype=float)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    radius = np.ones(len(x))
    for side in (1, -1):
        for *direction, width, height in BUMPS:
            centre = np.array(direction) * (side, 1, 1) / np.linalg.norm(direction)
            away = np.linalg.norm(x - centre, axis=1) / width
            radius += height * np.exp(-(away**2)) * (0.5 if direction[0] == 0 else 1)
    return Shape(x * radius[:, None] * (0.75, 0.9, 1.1), mesh.regular_faces)


def dented(shape, at, width, depth):
    """Pushed in around a point, towards the middle."""
    away = np.linalg.norm(shape.points - at, axis=1) / width
    inwards = -shape.points / np.linalg.norm(shape.points, axis=1, keepdims=True)
    return Shape(shape.points + depth * np.exp(-(away**2))[:, None] * inwards, shape.faces)


ANGLES = (20, -25, 35)  # degrees


def turned(shape):
    return Shape(synthetic.rotate(shape.points, *ANGLES) + (3, 1, 2), shape.faces)


def ant():
    """PyVista's, its length along z, mirrored by x = 0."""
    mesh = symsurf.read(Path(examples.antfile))
    shorter, longer = sorted((1, 2), key=lambda axis: np.ptp(mesh.points[:, axis]))
    points = mesh.points[:, [0, shorter, longer]]
    return Shape(points - (points.min(axis=0) + points.max(axis=0)) / 2, mesh.faces)


def bent(shape):
    radius = 0.7 * np.ptp(shape.points[:, 2])
    x, y, z = shape.points.T
    angle = z / radius
    bow = (radius + x) * np.cos(angle) - radius, y, (radius + x) * np.sin(angle)
    return Shape(np.column_stack(bow), shape.faces)


def without(shape, lost):
    """Without the points that are lost, and their faces."""
    kept = ~lost
    faces = (np.cumsum(kept) - 1)[shape.faces[kept[shape.faces].all(axis=1)]]
    return Shape(shape.points[kept], faces)


def write(result, path, camera=None):
    result.plot(path, camera=camera)
    image = Image.open(path).convert("RGB").resize((800, 600), Image.Resampling.LANCZOS)
    image.quantize(255).save(path, optimize=True)


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
    write(symsurf.straighten(bent(ant())), folder / "straighten.png", above)
    if "complete" in symsurf.operations():
        x, y, z = symmetric.points.T
        broken = without(symmetric, (x > 0.1) & (y < 0.3 + 0.2 * np.sin(5 * z)) & (z > -0.3))
        write(symsurf.complete(broken, plane), folder / "complete.png", front)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
