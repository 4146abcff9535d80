"""Draws the pictures of docs/concepts.md.

python docs/pictures/concepts.py docs/images/concepts
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

plt.rcParams |= {"font.size": 11, "svg.hashsalt": "symsurf", "svg.fonttype": "path"}
LEFT, RIGHT, MIRROR, IMAGE, NONE = "#c8553d", "#2f4858", "#1f5fa8", "#e6a532", "#9aa0a6"


def canvas(count=1, height=3.4, width=3.6):
    figure, axes = plt.subplots(1, count, figsize=(width * count, height), squeeze=False)
    for each in axes[0]:
        each.set_aspect("equal")
        each.axis("off")
    return figure, axes[0]


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, facecolor="white", metadata={"Date": None})
    plt.close(figure)


def half(count=12):
    """A wing's outline to the right of x = 0."""
    t = np.linspace(0.06, 0.94, count)
    return np.column_stack([0.25 + 0.75 * np.sin(np.pi * t) ** 1.3 * (1 - 0.35 * t), 2 * t - 1])


def over(points, bend=0.0):
    """Bent over a circle of that curvature through the origin, whose tangent there is x = 0."""
    if bend == 0:
        return points
    radius, (x, y) = 1 / bend, points.T
    return np.column_stack(
        [(radius + x) * np.cos(y / radius) - radius, (radius + x) * np.sin(y / radius)]
    )


def sides(bend=0.0):
    right = half()
    return over(right, bend), over(right * (-1, 1), bend)


def line(bend=0.0):
    y = np.linspace(-1.15, 1.15, 60)
    return over(np.column_stack([0 * y, y]), bend)


def mirror(folder):
    """A plane and a bent mirror, each with a point, its foot and its image."""
    figure, panels = canvas(2)
    for axes, bend, name in zip(panels, (0.0, 0.7), ("a plane", "a curved mirror"), strict=True):
        right, left = sides(bend)
        axes.plot(*line(bend).T, color=MIRROR, lw=2)
        axes.plot(*left.T, "o", color=LEFT, ms=5)
        axes.plot(*right.T, "o", color=RIGHT, ms=5)
        chosen = 4
        foot = over(half()[[chosen]] * (0, 1), bend)[0]
        axes.plot(*np.array([right[chosen], foot, left[chosen]]).T, color=NONE, lw=1)
        axes.plot(*foot, "s", color=MIRROR, ms=6)
        for text, at, to in (("x", right[chosen], (9, -3)), ("x'", left[chosen], (-18, -3)),
                             ("foot", foot, (5, -14))):  # fmt: skip
            axes.annotate(text, at, xytext=to, textcoords="offset points")
        axes.set_title(name, fontsize=11)
    save(figure, folder / "mirror.svg")


def residual(folder):
    """The image, the partner nearest to it, and the distance between them."""
    figure, (axes,) = canvas(1, 3.6, 6.6)
    rng = np.random.default_rng(3)
    right, left = half(9), half(9) * (-1, 1)
    left = left + rng.normal(0, 0.06, left.shape)
    left = left[np.arange(len(left)) != 6]
    image = right * (-1, 1)
    axes.plot(*line().T, color=MIRROR, lw=2)
    axes.plot(*right.T, "o", color=RIGHT, ms=6, label="points")
    axes.plot(*left.T, "o", color=LEFT, ms=5, label="points of the other side")
    axes.plot(*image.T, "o", mfc="none", mec=IMAGE, ms=9, mew=1.6, label="images")
    away = np.linalg.norm(image[:, None] - left, axis=2)
    for number, row in enumerate(away):
        if row.min() < 0.2:
            axes.plot(*np.array([image[number], left[row.argmin()]]).T, color=IMAGE, lw=2.2)
    axes.plot(*right[6], "o", color=NONE, ms=6, label="without a partner")
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False)
    save(figure, folder / "residual.svg")


def score(folder):
    """The share of the shape that is mapped onto it."""
    figure, panels = canvas(3, 3.2, 3.0)
    right, left = sides()
    rng = np.random.default_rng(1)
    drawn = [
        ("1: exact", left, np.ones(len(right), bool)),
        ("0.7: a part is missing", left[:8], np.arange(len(right)) < 8),
        (
            "0: no symmetry",
            np.column_stack([-rng.uniform(0.2, 1, 12), rng.uniform(-1, 1, 12)]),
            None,
        ),
    ]
    for axes, (title, other, has_partner) in zip(panels, drawn, strict=True):
        if has_partner is None:
            has_partner = np.zeros(len(right), bool)
        axes.plot(*line().T, color=MIRROR, lw=2)
        axes.plot(*other.T, "o", color=LEFT if has_partner.any() else NONE, ms=6)
        axes.plot(*right[has_partner].T, "o", color=RIGHT, ms=6)
        axes.plot(*right[~has_partner].T, "o", color=NONE, ms=6)
        axes.set_title(title, fontsize=11)
        axes.set_xlim(-1.1, 1.1)
        axes.set_ylim(-1.2, 1.2)
    save(figure, folder / "score.svg")


def mapping(folder):
    """Perpendicular and along a fixed direction."""
    figure, panels = canvas(2, 2.0)
    x = np.linspace(-1.2, 1.2, 60)
    feet = np.linspace(-1, 1, 9)
    height, slope = lambda x: 0.25 * np.sin(2.2 * x), lambda x: 0.55 * np.cos(2.2 * x)
    normal = np.column_stack([-slope(feet), np.ones(9)])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    fixed = np.tile(np.array([0.45, 0.9]) / np.hypot(0.45, 0.9), (9, 1))
    titles = "along its normals", "along one direction"
    for axes, direction, title in zip(panels, (normal, fixed), titles, strict=True):
        away = (0.35 + 0.12 * np.cos(3 * feet))[:, None] * direction
        middle = np.column_stack([feet, height(feet)])
        axes.plot(x, height(x), color=MIRROR, lw=2)
        for a, b in zip(middle + away, middle - away, strict=True):
            axes.plot(*np.array([a, b]).T, color=NONE, lw=1)
        axes.plot(*(middle + away).T, "o", color=RIGHT, ms=5)
        axes.plot(*(middle - away).T, "o", color=LEFT, ms=5)
        axes.set_title(title, fontsize=11)
    save(figure, folder / "mapping.svg")


def main(folder):
    folder.mkdir(exist_ok=True)
    for draw in (mirror, residual, score, mapping):
        draw(folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
