"""The shapes that the examples work on: each mirrored by x = 0 until something happens to it."""

import numpy as np
import pyvista

from symsurf import Shape

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
    """Looks along -y."""
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
    """Pushed in around a point, towards the middle; pulled out where the depth is below 0."""
    away = np.linalg.norm(shape.points - at, axis=1) / width
    inwards = -shape.points / np.linalg.norm(shape.points, axis=1, keepdims=True)
    return Shape(shape.points + depth * np.exp(-(away**2))[:, None] * inwards, shape.faces)


def without(shape, lost):
    """Without the points that are lost, and their faces."""
    kept = ~lost
    faces = (np.cumsum(kept) - 1)[shape.faces[kept[shape.faces].all(axis=1)]]
    return Shape(shape.points[kept], faces)


def face_scan(nsub=6):
    """In millimetres, as a scanner sees it: the front of a head with a swollen cheek."""
    swollen = dented(head(nsub), at=(0.45, -0.55, -0.15), width=0.3, depth=-0.06)
    _, y, z = swollen.points.T
    seen = without(swollen, (y > 0.1 + 0.1 * np.sin(4 * z)) | (z < -0.9))
    return Shape(seen.points * 100, seen.faces)


def _ball(x, centre, half_axes):
    """Below 0 inside, about in lengths."""
    away = np.sqrt(sum(((x[i] - centre[i]) / half_axes[i]) ** 2 for i in range(3)))
    return (away - 1) * min(half_axes)


def _rod(x, start, end, thick):
    start, end = np.array(start, float), np.array(end, float)
    along = sum((x[i] - start[i]) * (end - start)[i] for i in range(3)) / ((end - start) ** 2).sum()
    along = np.clip(along, 0, 1)
    return np.sqrt(sum((x[i] - start[i] - along * (end - start)[i]) ** 2 for i in range(3))) - thick


def vertebra(cells=90):
    """A bone in millimetres: its body in front, an arch behind, a process at either side."""
    axes = [
        np.linspace(-1.3, 1.3, cells + 1),
        np.linspace(-0.8, 1.7, cells),
        np.linspace(-0.7, 0.7, cells // 2),
    ]
    x, y, z = np.meshgrid(*axes, indexing="ij")
    at = abs(x), y, z
    parts = [
        np.maximum(_ball(at, (0, -0.05, 0), (0.62, 0.5, 2)), abs(z) - 0.34),
        _rod(at, (0.38, 0.35, 0.05), (0.4, 0.75, 0.05), 0.13),
        _rod(at, (0.4, 0.75, 0.05), (0, 1.02, 0), 0.13),
        _rod(at, (0.4, 0.7, 0.05), (1.1, 0.95, 0.1), 0.12),
        _rod(at, (0, 1.02, 0), (0, 1.5, -0.25), 0.11),
        _rod(at, (0.42, 0.72, -0.3), (0.38, 0.72, 0.4), 0.12),
    ]  # fmt: skip
    inside = -np.log(sum(np.exp(-18 * part) for part in parts)) / 18  # their smooth union
    grid = pyvista.ImageData(
        dimensions=x.shape,
        origin=[axis[0] for axis in axes],
        spacing=[axis[1] - axis[0] for axis in axes],
    )
    grid["inside"] = inside.ravel(order="F")
    surface = grid.contour([0.0]).smooth_taubin(n_iter=30)
    return Shape(np.array(surface.points, dtype=float) * 20, surface.regular_faces.astype(np.int64))


def half_doll(cells=40):
    """The side x >= 0 of a doll that looks along -y, open at x = 0."""
    axes = [
        np.linspace(0, 2, cells),
        np.linspace(-0.7, 0.7, cells),
        np.linspace(-2.1, 2, 2 * cells),
    ]
    x = np.meshgrid(*axes, indexing="ij")
    parts = [
        _ball(x, (0, 0, 1.4), (0.42, 0.45, 0.5)),
        _ball(x, (0, 0, 0.2), (0.5, 0.36, 0.85)),
        _rod(x, (0.4, 0, 0.65), (1.7, 0, 0.55), 0.17),
        _rod(x, (0.25, 0, -0.4), (0.4, 0, -1.75), 0.2),
        _rod(x, (0.4, 0, -1.8), (0.45, -0.3, -1.85), 0.17),
    ]
    inside = -np.log(sum(np.exp(-14 * part) for part in parts)) / 14
    grid = pyvista.RectilinearGrid(*axes)
    grid["inside"] = inside.ravel(order="F")
    surface = grid.contour([0.0])
    return Shape(np.array(surface.points, dtype=float), surface.regular_faces.astype(np.int64))


def with_an_arm_raised(shape, degrees):
    """The arm of a doll where x > 0, turned about the shoulder."""
    shoulder = np.array([0.45, 0, 0.65])
    out, _, up = shape.points.T
    share = np.clip((out - 0.4) / 0.4, 0, 1) * np.clip((up + 0.1) / 0.4, 0, 1)
    angle = np.radians(degrees) * share**2 * (3 - 2 * share)
    x, y, z = (shape.points - shoulder).T
    turned = x * np.cos(angle) - z * np.sin(angle), y, x * np.sin(angle) + z * np.cos(angle)
    return Shape(np.column_stack(turned) + shoulder, shape.faces)


def leaf(length=10.0, across=41, along=161):
    """Folded along its midrib, with veins; the midrib lies along z."""
    s, t = np.meshgrid(np.linspace(-1, 1, across), np.linspace(0.002, 0.998, along), indexing="ij")
    half_width = 0.025 * length + 0.27 * length * np.sin(
        np.pi * np.clip(t / 0.92 - 0.08, 0, 1) ** 0.55
    )
    half_width *= 1 - t**6
    fold = 0.35 * abs(s) * half_width
    veins = 0.012 * length * np.cos(16 * np.pi * (t - 0.15 * abs(s))) * (1 - abs(s)) * abs(s)
    points = np.stack([s * half_width, fold + veins, (t - 0.5) * length], -1).reshape(-1, 3)
    index = np.arange(across * along).reshape(across, along)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    return Shape(points, faces)


def bent(shape, radius):
    """Bent along z about an axis along y, so that its mirror becomes a cylinder."""
    x, y, z = shape.points.T
    bow = (radius + x) * np.cos(z / radius) - radius, y, (radius + x) * np.sin(z / radius)
    return Shape(np.column_stack(bow), shape.faces)
