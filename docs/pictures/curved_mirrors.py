"""Takes the pictures of curved mirrors for docs/methods and docs/what_can_be_found.md.

python docs/pictures/curved_mirrors.py docs/images
"""

import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image
from pyvista import examples

import symsurf
from symsurf import Shape, synthetic
from symsurf.plotting import INK, draw, new_plotter


class Panel(NamedTuple):
    title: str
    points: np.ndarray
    method: str
    view: tuple[float, float, float] = (0.25, -1, 0.3)
    faces: np.ndarray | None = None
    range: float = 1  # of the colours, % of the diagonal


def picture(path, *panels):
    """Results side by side, a title under each, with the chords of some pairs."""
    plotter = new_plotter(
        True, shape=(1, len(panels)), window_size=(480 * len(panels), 420), border=False
    )
    for column, panel in enumerate(panels):
        plotter.subplot(0, column)
        result = symsurf.detect(panel.points, method=panel.method)
        draw(plotter, result, shape=Shape(panel.points, panel.faces), residual_range=panel.range)
        if panel.faces is None:
            chosen = result.pairs[:: max(1, len(result.pairs) // 60)]
            plotter.add_lines(panel.points[chosen.ravel()], color=INK, width=1)
        plotter.remove_scalar_bar()
        plotter.view_vector(panel.view)
        plotter.camera.zoom(1.15)
        verdict = result.statistics.get("verdict")
        found = f"score {result.score:.2f}" + (f', "{verdict}"' if verdict else "")
        title = f"{panel.title}\n{panel.method}: {found}"
        plotter.add_text(title, position="lower_edge", font_size=9, color=INK)
    image = Image.fromarray(plotter.screenshot(return_img=True))
    image.quantize(64).save(path, optimize=True)
    plotter.close()


def bent(points, radius):
    """A shape that mirrors in x, bent along z about an axis along y."""
    x, y, z = (points - points.mean(axis=0) * (0, 1, 1)).T
    angle = z / radius
    return np.column_stack([(radius + x) * np.cos(angle) - radius, y, (radius + x) * np.sin(angle)])


def ant():
    """PyVista's, its length along z."""
    mesh = symsurf.read(Path(examples.antfile))
    shorter, longer = sorted((1, 2), key=lambda axis: np.ptp(mesh.points[:, axis]))
    return Shape(mesh.points[:, [0, shorter, longer]], mesh.faces)


def sheets(name, distance, count, rng, reach, noise=0.0):
    """Both sides of a surface; distance: a function of x."""
    f = synthetic.surface(name)
    x, y = rng.uniform(-1, 1, size=(2, count)) * [[reach], [0.4 * reach]]
    slope_x, slope_y = f.gradient(x, y)
    normal = np.column_stack([-slope_x, -slope_y, np.ones(count)])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    middle = np.column_stack([x, y, f(x, y)])
    away = distance(x)[:, None] * normal
    points = np.vstack([middle + away, middle - away])
    return points + noise * rng.normal(size=points.shape)


def over_f1(height, count, rng):
    """A body that f1 mirrors along z: closed over the unit disc."""
    place = rng.uniform(-1, 1, size=(4 * count, 2))
    x, y = place[np.linalg.norm(place, axis=1) < 1][:count].T
    f = synthetic.surface("f1")(2 * x, y)
    return np.vstack([np.column_stack([x, y, f + side * height(x, y)]) for side in (1, -1)])


def directions(count, rng):
    x = rng.normal(size=(count, 3))
    return x / np.linalg.norm(x, axis=1, keepdims=True)


PARTS = np.array([  # centre and half axes of balls: body, head, and limbs on the one side
    [0.0, 0.0, 0.0, 0.45, 0.16, 0.11],
    [0.55, 0.05, 0.0, 0.14, 0.13, 0.09],
    [0.25, -0.1, 0.2, 0.06, 0.2, 0.05],
    [-0.05, -0.05, 0.26, 0.12, 0.05, 0.14],
    [-0.35, -0.12, 0.17, 0.07, 0.18, 0.05],
])  # fmt: skip


def crooked_figure(count, rng):
    """A body with limbs on either side of a wave; no point has an exact partner."""
    areas = np.prod(PARTS[:, 3:], axis=1) ** (2 / 3) * (1 + (PARTS[:, 2] > 0))
    part = PARTS[rng.choice(len(PARTS), size=count, p=areas / areas.sum())]
    x, y, z = (part[:, :3] + part[:, 3:] * directions(count, rng)).T
    z *= np.where(part[:, 2] > 0, rng.choice([-1, 1], size=count), 1)
    height, slope = 0.1 * np.sin(4 * x), 0.4 * np.cos(4 * x)
    normal = np.column_stack([-slope, np.zeros(count), np.ones(count)])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.column_stack([x, y, height]) + z[:, None] * normal


def blob(count, rng):
    direction = directions(count, rng)
    waves = rng.normal(size=(12, 3)) * rng.uniform(1, 4, size=(12, 1))
    bumps = np.cos(direction @ waves.T + rng.uniform(0, 6, size=12)) @ rng.normal(size=12)
    return direction * np.exp(0.4 * bumps / bumps.std())[:, None]


def main(folder):
    rng = np.random.default_rng(0)
    straight = ant()
    crooked = bent(straight.points, 0.7 * np.ptp(straight.points[:, 2]))
    mirror = symsurf.detect(crooked, method="auto").mirror
    above = (0.3, 1, 0.5)
    picture(
        folder / "bent_ant.png",
        Panel("bent", crooked, "auto", above, straight.faces, 3),
        Panel("straightened over that cylinder", symsurf.bend(crooked, mirror), "auto", above,
              straight.faces, 3),
    )  # fmt: skip

    slanted = straight.points + np.tan(np.radians(30)) * straight.points[:, :1] * (0, 0, 1)
    oblique = symsurf.detect(slanted, method="auto").mirror
    picture(
        folder / "sheared_ant.png",
        Panel("sheared by 30 degrees", slanted, "plane", above, straight.faces, 3),
        Panel("the same", slanted, "auto", above, straight.faces, 3),
        Panel("straightened over that plane", symsurf.bend(slanted, oblique), "plane", above,
              straight.faces, 3),
    )  # fmt: skip

    def wavy(x):
        return 0.25 + 0.12 * (1 + np.sin(3 * x))

    picture(
        folder / "perpendicular.png",
        Panel("two sheets around f1", sheets("f1", wavy, 600, rng, 2), "perpendicular"),
        Panel("cones, one in the other", sheets("f3", lambda x: 0 * x + 0.25, 600, rng, 2),
              "perpendicular"),
    )  # fmt: skip

    figure = crooked_figure(4000, np.random.default_rng(5))
    from_above = (0.15, 1, 0.4)
    picture(
        folder / "bent_solid.png",
        Panel("a crooked figure", figure, "plane", from_above, range=3),
        Panel("the same", figure, "perpendicular", from_above, range=3),
    )

    def dome(x, y):
        return np.sqrt(1 - x**2 - y**2) * (1 + 0.3 * np.sin(4 * x + y))

    body = over_f1(dome, 500, rng)
    picture(
        folder / "fixed_direction.png",
        Panel("a closed body about f1", body, "fixed_direction"),
        Panel("with noise", body + 0.02 * rng.normal(size=body.shape), "fixed_direction"),
    )
    ball = directions(800, rng)
    close = sheets("f1", lambda x: 0 * x + 0.05, 400, rng, 2, noise=0.08)
    picture(
        folder / "not_found.png",
        Panel("a ball: any plane through its centre", ball, "auto"),
        Panel("a blob", blob(800, rng), "auto"),
        Panel("sheets closer than their noise", close, "perpendicular"),
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
