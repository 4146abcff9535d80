"""ParaView's real window: from the Filters menu to the picture of a mirror and of an asymmetry."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from desktop import Desktop, screen
from seeds import full_run

import symsurf

# The render view lies to the right of the panels and below the toolbars.
VIEW = (slice(240, 800), slice(320, 1260))
HELP_BUTTON = (269, 452)
HELP_PAGE = (slice(200, 800), slice(300, 960))


def colourful(pixels: np.ndarray) -> np.ndarray:
    """Pixels of a colour map's ends, red or blue; the background and white shapes are not."""
    red, blue = pixels[..., 0], pixels[..., 2]
    return np.abs(red - blue) > 90


def menu_keys(label: str) -> list[str]:
    """From the end of the Filters menu: Temporal, Symmetry Test Data, Symmetry; its entries are in
    alphabetical order."""
    titles = [operation.title.title() for operation in symsurf.operations().values()]
    entries = sorted([*titles, "Mirror Detection", "Mirror Reflection", "Symmetry Analysis"])
    return ["alt+l", "Up", "Up", "Up", "Right", *["Down"] * entries.index(label), "Return"]


def write_shape(path: Path, dent: float = 0) -> Path:
    """A lopsided mesh beside its reflection, in which one has a dent, as an OBJ file."""
    s, t = np.meshgrid(np.linspace(0, np.pi, 30), np.linspace(0, 2 * np.pi, 40))
    x = np.stack([np.sin(s) * np.cos(t), np.sin(s) * np.sin(t), np.cos(s)], -1).reshape(-1, 3)
    x *= (1 + 0.3 * np.sin(3 * x[:, 0] + x[:, 1]) + 0.2 * x[:, 1] * x[:, 2])[:, None]
    rows, columns = np.mgrid[:39, :29]
    corner = (rows * 30 + columns).ravel()
    quads = np.stack([corner, corner + 1, corner + 31, corner + 30], -1)
    dented = x - dent * np.exp(-((x - x[608]) ** 2).sum(axis=1) / 0.1)[:, None] * x
    points = np.vstack([dented, x * [-1, 1, 1] + [0.8, 0, 0]])
    faces = np.vstack([quads, quads[:, ::-1] + len(x)]) + 1
    lines = ["v {} {} {}".format(*p) for p in points] + ["f {} {} {} {}".format(*f) for f in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


@contextmanager
def paraview(environment: dict[str, str], plugin: Path, file: Path) -> Iterator[Desktop]:
    """Its window with the plugin, and a file that is not yet applied."""
    environment = environment | {"PV_PLUGIN_PATH": str(plugin.parent)}
    with screen(environment) as seen, Desktop(seen, str(file)) as desktop:
        yield desktop


@full_run
def test_menu_apply_and_the_mirror_is_drawn(
    environment: dict[str, str], plugin: Path, tmp_path: Path
) -> None:
    with paraview(environment, plugin, write_shape(tmp_path / "shape.obj")) as desktop:
        empty = desktop.settle()[VIEW]
        desktop.key("alt+a")
        desktop.wait_until(lambda now: (np.abs(now[VIEW] - empty).max(-1) > 20).mean() > 0.02)
        assert colourful(desktop.settle()[VIEW]).mean() < 0.005

        desktop.key(*menu_keys("Mirror Detection"))
        desktop.settle()
        desktop.key("alt+a")
        desktop.wait_until(lambda now: colourful(now[VIEW]).mean() > 0.01)


@full_run
def test_menu_apply_and_the_asymmetry_is_drawn_about_0(
    environment: dict[str, str], plugin: Path, tmp_path: Path
) -> None:
    with paraview(environment, plugin, write_shape(tmp_path / "shape.obj", dent=0.3)) as desktop:
        desktop.key("alt+a")
        desktop.settle()
        desktop.key(*menu_keys("Mirror Asymmetry"))
        desktop.settle()
        desktop.key("alt+a")
        desktop.wait_until(lambda now: colourful(now[VIEW]).mean() > 0.001)
        # The shape alone, between the axes and the legend of the colours. The dent in its left half
        # has one end of the colours, the counterpart in the right half the other, the rest neither.
        pixels = desktop.settle()[300:680, 560:1020]
        redder = pixels[..., 0] - pixels[..., 2]
        (_, dent), (_, counterpart) = np.nonzero(redder > 60), np.nonzero(redder < -60)
        for found, half in ((dent, 0), (counterpart, 1)):
            assert 1000 < len(found) < 0.1 * redder.size
            assert (found // (redder.shape[1] // 2) == half).mean() > 0.9


@full_run
def test_the_button_for_help_shows_the_filters_page(
    environment: dict[str, str], plugin: Path, tmp_path: Path
) -> None:
    with paraview(environment, plugin, write_shape(tmp_path / "shape.obj")) as desktop:
        desktop.key("alt+a")
        desktop.settle()
        desktop.key(*menu_keys("Mirror Detection"))
        desktop.settle()
        desktop.click(*HELP_BUTTON)
        desktop.wait_until(lambda now: (now[HELP_PAGE] == 255).all(axis=-1).mean() > 0.5)
        # Tables have long straight lines, ParaView's own front page has none.
        page = desktop.settle()[HELP_PAGE].max(axis=-1) < 160
        assert (page.mean(axis=1) > 0.9).sum() > 5


def test_picture_of_the_mirror(
    run_host: Callable[..., Any], environment: dict[str, str], tmp_path: Path
) -> None:
    with screen(environment) as seen:
        display = f"env DISPLAY={seen['DISPLAY']} pvpython"
        drawn = run_host(display, "picture.py", tmp_path / "picture.png")
    assert drawn["nothing"] == 0
    for name in ("Shape", "Mirror", "Surface Points"):
        assert 0.001 < drawn[name] < 0.9, name
