"""Takes the pictures of docs/neighbours_light.md.

python docs/pictures/light.py docs/images
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import symsurf

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
from accuracy.ray_casting import LitMirror, Screen, cast, seen

SIDE = 240  # pixels of a screen
GAP = 12


def side_by_side(path, *panels):
    strip = np.full((GAP, SIDE, 3), 255, np.uint8)
    rows = [part for panel in panels for part in (strip.swapaxes(0, 1), panel)][1:]
    Image.fromarray(np.hstack(rows)).save(path, optimize=True)


def gray(values, top):
    """An image, x to the right and y up; the root of what is bright."""
    shade = (255 * np.sqrt(np.clip(values / top, 0, 1))).astype(np.uint8)
    return np.repeat(shade.T[::-1, :, None], 3, axis=2)


def caustics(path):
    """The same screen: how many paths, the irradiance, and rays that were cast and counted."""
    rng = np.random.default_rng(3)
    a, b = 0.34, 0.2  # a bowl that bends more along x than along y
    bowl = symsurf.Quadric(np.diag([a, b, 0]), (0, 0, -1), 0)
    lit = LitMirror(bowl, lambda x, y: a * x * x + b * y * y, np.array([0.7, -0.5, 2.3]))
    ends, solid = cast(lit, 1.3, rng)
    half = 0.6
    screen = Screen(np.array([*np.median(ends[:, :2], axis=0), 1.3]), half)
    points = screen.spread(np.ones((SIDE, SIDE), int), rng)
    sources, flux = seen(lit, points)
    count = np.bincount(sources, minlength=SIDE**2).reshape(SIDE, SIDE)
    bright = np.bincount(sources, flux, minlength=SIDE**2).reshape(SIDE, SIDE)
    coarse = SIDE // 3
    counted = screen.summed(ends, solid, coarse) / (2 * half / coarse) ** 2
    top = np.quantile(bright, 0.97)
    side_by_side(path, gray((count / count.max()) ** 2, 1), gray(bright, top),
                 gray(np.kron(counted, np.ones((3, 3))), top))  # fmt: skip


def room(count):
    """(n, 3) points of the walls of a box of 8, and (n, 3) colours: a chequered pattern a wall."""
    u, v = (each.ravel() for each in np.meshgrid(*2 * [np.linspace(-4, 4, count)]))
    dark = (np.floor(u) + np.floor(v)) % 2
    points, colours = [], []
    for axis in range(3):
        for end in (-4, 4):
            points.append(np.insert(np.column_stack([u, v]), axis, end, axis=1))
            hue = np.roll((230, 120, 70), axis) if end > 0 else np.roll((90, 150, 220), axis)
            colours.append(hue * (0.45 + 0.55 * dark)[:, None])
    return np.vstack(points), np.vstack(colours).astype(np.uint8)


def reflected_room(mirror, eye, count=260):
    """What a camera at the eye that looks at the origin sees in the mirror: each point of the room
    where it is reflected, the nearest mirror in front."""
    points, colours = room(count)
    found = mirror.reflection_points(points, eye)
    # Outside, where the mirror is seen first.
    ways = eye - found.positions
    outward = 2 * found.positions @ mirror.matrix + mirror.linear
    front = (ways * outward).sum(axis=1) > 0
    ahead = -eye / np.linalg.norm(eye)
    right = np.cross(ahead, (0, 0, 1))
    right /= np.linalg.norm(right)
    depth = -ways @ ahead
    x, y = (-ways @ right) / depth, (-ways @ np.cross(right, ahead)) / depth
    column, row = ((1 + 2.3 * each) * SIDE / 2 for each in (x, -y))
    inside = front & (depth > 0) & (column >= 0) & (column < SIDE) & (row >= 0) & (row < SIDE)
    image = np.full((SIDE, SIDE, 3), 255, np.uint8)
    image[row[inside].astype(int), column[inside].astype(int)] = colours[found.sources[inside]]
    return image


def mirrors_of_revolution(path):
    """x^2 + y^2 + A z^2 + B z - C = 0 for a sphere, a spheroid, a paraboloid, a hyperboloid."""
    eye = np.array([2.6, -1.8, 1.1])
    numbers = [(1, 0, 1), (0.4, 0, 0.7), (0, 1, 0.5), (-0.5, 0, 0.25)]
    mirrors = [symsurf.Quadric(np.diag([1, 1, a]), (0, 0, b), -c) for a, b, c in numbers]
    side_by_side(path, *(reflected_room(mirror, eye) for mirror in mirrors))


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    caustics(folder / "light_screen.png")
    mirrors_of_revolution(folder / "light_room.png")
