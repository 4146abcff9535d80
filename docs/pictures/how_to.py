"""Takes the pictures of docs/how_to that show landmarks, cohorts and batches.

python docs/pictures/how_to.py docs/images/how_to
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pyvista
from PIL import Image

import symsurf
from symsurf.plotting.drawing import COLOURS, colour_map, draw_mirror, draw_scalars, look, prepare

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "python"))
from shapes import dented, head

FRONT, UP = np.array((0.3, -0.95, 0.1)), np.array((0.0, 0, 1))
SKIN = "#efdcb8"
DOTS = {"render_points_as_spheres": True, "point_size": 34}
PLANE = symsurf.Plane((1, 0, 0), 0)
# On the skin of the head: directions, on one side and on the midline.
PAIRED = [(0.42, -0.9, 0.27), (0.2, -0.93, 0.24), (0.33, -0.9, 0.55), (0.17, -0.95, -0.04)]
PAIRED += [(0.19, -0.9, -0.33), (0.75, -0.6, -0.3), (0.97, -0.25, 0.05)]
MIDLINE = [(0, -1, 0.95), (0, -0.97, 0.3), (0, -0.97, 0.05), (0, -0.9, -0.3), (0, -0.85, -0.6)]


def landmarks(shape):
    """One side, the other, and the midline; and the pairs."""
    directions = shape.points / np.linalg.norm(shape.points, axis=1, keepdims=True)

    def on_skin(rays):
        unit = np.array(rays, dtype=float) / np.linalg.norm(rays, axis=1, keepdims=True)
        return shape.points[(directions @ unit.T).argmax(axis=0)]

    half = on_skin(PAIRED)
    points = np.concatenate([half, half * (-1, 1, 1), on_skin(MIDLINE) * (0, 1, 1)])
    return points, [(i, i + len(half)) for i in range(len(half))]


def plotter_of(shape):
    plotter = pyvista.Plotter(off_screen=True, window_size=(1200, 900))
    prepare(plotter)
    plotter.add_mesh(shape.to_pyvista(), color=SKIN, smooth_shading=True, ambient=0.25)
    return plotter


def take(plotter, points, path, has_bar=False):
    look(plotter, FRONT / np.linalg.norm(FRONT), UP, points, "", has_bar)
    plotter.screenshot(path)
    plotter.close()
    shrink(path)


def shrink(path):
    image = Image.open(path).convert("RGB").resize((640, 480), Image.Resampling.LANCZOS)
    image.save(path, optimize=True)


def pairs_of_landmarks(path):
    shape = head(5)
    points, _ = landmarks(shape)
    found = symsurf.landmark_pairs(points, PLANE)
    plotter = plotter_of(shape)
    out = points * 1.02
    for number, (a, b) in enumerate(found.pairs):
        colour = plt.get_cmap("tab10")(number)[:3]
        plotter.add_mesh(pyvista.PolyData(out[[a, b]]), color=colour, **DOTS)
    plotter.add_mesh(pyvista.PolyData(out[found.midline]), color="#333333", **DOTS)
    vertices, triangles = PLANE.mesh(shape.points)
    draw_mirror(plotter, vertices, triangles)
    take(plotter, np.vstack([shape.points, vertices]), path)


def spread_of_landmarks(path):
    """Sixty individuals about their mean, ten times as far apart as they are."""
    shape = head(5)
    points, pairs = landmarks(shape)
    rng = np.random.default_rng(0)
    individuals = points + 0.004 * rng.normal(size=(60, *points.shape))
    individuals[:, 0] += (0.03, 0, 0.02)  # directional
    cohort = symsurf.cohort(individuals, pairs, permutations=0)
    size = cohort.size.mean()
    fitted = size * cohort.mean
    turn = np.linalg.svd((fitted - fitted.mean(axis=0)).T @ (points - points.mean(axis=0)))
    rotation = turn[0] @ turn[2]
    own, common = size * cohort.fluctuating @ rotation, size * cohort.directional @ rotation
    plotter = plotter_of(shape)
    points = points + 0.15 * FRONT  # before the skin, from where they are seen
    cloud = (points + 10 * (own + common)).reshape(-1, 3)
    plotter.add_mesh(
        pyvista.PolyData(cloud), color="#2f5fb0", render_points_as_spheres=True, point_size=9
    )
    for start, way in zip(points, 10 * common):
        if np.linalg.norm(way) > 0.02:
            arrow = pyvista.Arrow(start=start + 0.1 * FRONT, direction=way, scale="auto")
            plotter.add_mesh(arrow, color="#a83244")
    take(plotter, shape.points, path)


def percentile_of_a_face(path):
    shape = head(5)
    other = symsurf.correspondences(shape, PLANE).index
    pairs = [(i, j) for i, j in enumerate(other) if i < j]
    rng = np.random.default_rng(0)
    x = shape.points
    waves = np.array([np.sin(5 * x @ rng.normal(size=3) + rng.uniform(0, 6)) for _ in range(40)])
    faces = x * (1 + 0.015 * rng.normal(size=(41, 40)) @ waves / 6)[:, :, None]
    patient = symsurf.Shape(faces[-1], shape.faces)
    faces[-1] = dented(patient, (0.45, -0.55, -0.15), 0.22, -0.06).points
    cohort = symsurf.cohort(faces, pairs, permutations=0)
    plotter = pyvista.Plotter(off_screen=True, window_size=(1200, 900))
    prepare(plotter)
    draw_scalars(
        plotter,
        symsurf.Shape(faces[-1], shape.faces).to_pyvista(),
        cohort.percentile(40),
        "percentile",
        (90, 100),
        colour_map(COLOURS),
    )
    take(plotter, x, path, has_bar=True)


def jobs_over_time(path):
    """A sketch: four jobs, of which three are killed and go on."""
    rng = np.random.default_rng(3)
    kills = {0: (5.2,), 2: (3.1, 7.4)}
    figure, axes = plt.subplots(figsize=(6.4, 4.8))
    ends = []
    for job in range(4):
        clock, killed = 0.0, list(kills.get(job, ()))
        for _ in range(20):
            takes = rng.uniform(0.3, 0.7)
            if killed and clock + takes > killed[0]:
                stop = killed.pop(0)
                axes.barh(-job, stop - clock, 0.5, clock, color="#de8350", edgecolor="white")
                axes.plot(stop, -job, "x", color="#a83244", markersize=11, markeredgewidth=3)
                clock = stop + 0.8
            axes.barh(-job, takes, 0.5, clock, color="#7fb2ee", edgecolor="white")
            clock += takes
        ends.append(clock)
    end = max(ends) + 0.9
    for job, clock in enumerate(ends):
        axes.annotate(
            "",
            (end, -job),
            (clock + 0.05, -job),
            arrowprops={"arrowstyle": "-|>", "color": "#333333", "shrinkB": 2},
        )
    axes.barh(-1.5, 0.5, 3.5, end, color="#2f5fb0")
    axes.text(end + 0.25, 0.32, "one table", ha="center", color="#333333", fontsize=12)
    axes.set_yticks([0, -1, -2, -3], [f"shard {i}/4" for i in range(1, 5)], fontsize=12)
    axes.set_xticks([])
    axes.set_xlabel("time: a bar a file, a cross where the job is killed", fontsize=12)
    axes.set_xlim(0, end + 1)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(length=0)
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    plt.close(figure)


def main(folder):
    folder.mkdir(exist_ok=True)
    pairs_of_landmarks(folder / "landmarks.png")
    spread_of_landmarks(folder / "fluctuating_asymmetry.png")
    percentile_of_a_face(folder / "facial_asymmetry.png")
    jobs_over_time(folder / "many_files.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
