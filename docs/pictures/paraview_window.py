"""Takes the pictures of ParaView's window for docs/paraview.md: the menu, the panel and its help.

SYMSURF_PARAVIEW_BUILD=build/paraview build/venv/bin/python docs/pictures/paraview_window.py docs/images
"""

import os
import sys
import tempfile
import time
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "paraview"))
from desktop import Desktop, screen
from test_gui import HELP_BUTTON, menu_keys, write_shape


def build_environment(home):
    build = Path(os.environ.get("SYMSURF_PARAVIEW_BUILD", ROOT / "build" / "paraview")).resolve()
    (plugin,) = build.glob("lib/paraview-*/plugins/SymsurfPlugin/SymsurfPlugin.so")
    runtime = Path(home, "runtime")
    runtime.mkdir(mode=0o700)
    return os.environ | {
        "HOME": home,
        "XDG_RUNTIME_DIR": str(runtime),
        "PV_PLUGIN_PATH": str(plugin.parent),
    }


def part_of(desktop, box, path):
    pixels = desktop.settle()
    Image.fromarray(pixels.astype("uint8")).crop(box).save(path, optimize=True)


def main(folder):
    with tempfile.TemporaryDirectory() as home:
        environment = build_environment(home)
        shape = write_shape(Path(home, "shape.obj"), dent=0.3)
        with screen(environment) as seen, Desktop(seen, str(shape)) as desktop:
            desktop.key("alt+a")
            desktop.settle()
            *keys, enter = menu_keys("Mirror Asymmetry")
            desktop.key(*keys)
            part_of(desktop, (0, 0, 700, 740), folder / "paraview-menu.png")
            desktop.key(enter)
            desktop.settle()
            desktop.drag((297, 478), (420, 478))  # the panel wider
            desktop.key("alt+a")
            part_of(desktop, (0, 0, 1280, 842), folder / "paraview-panel.png")
            desktop.drag((420, 478), (297, 478))
            desktop.click(*HELP_BUTTON)
            time.sleep(5)
            part_of(desktop, (0, 66, 1026, 842), folder / "paraview-help.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
