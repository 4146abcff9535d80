"""What happens in Blender's window: a run that finishes, one that Esc cancels, undo, and the settings of the
panel. Run by `blender --enable-event-simulate --python window.py -- PICTURES`; prints what it saw as one line
of JSON."""

import json
import os
import subprocess
import sys
import time
import traceback

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

PICTURES = sys.argv[sys.argv.index("--") + 1]
SEEN = {}
# A click on the title of Mirror symmetrization, in a window of 1280 x 800.
OPENING = [
    (kind, value, 850, 448)
    for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE"))
]


def _view():
    """What operators are called with, as from a button in the 3D view."""
    window = bpy.context.window_manager.windows[0]
    area = next(each for each in window.screen.areas if each.type == "VIEW_3D")
    region = next(each for each in area.regions if each.type == "WINDOW")
    return {"window": window, "area": area, "region": region}


def _press(key):
    window = bpy.context.window_manager.windows[0]
    x, y = window.width // 2, window.height // 2
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type=key, value=value, x=x, y=y)


def _invoke(name, **options):
    with bpy.context.temp_override(**_view()):
        return sorted(getattr(bpy.ops.symsurf, name)("INVOKE_DEFAULT", True, **options))


def _until(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        yield 0.05
    if not condition():
        raise TimeoutError(f"not within {seconds} s")


def _steps():
    from heads import coordinates, dented, head, set_coordinates

    _press("ESC")  # closes what Blender shows at its first start
    yield 0.5
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    shape, _ = head(200, 100)
    dented(shape)
    points = coordinates(shape)
    points += 0.1 * np.exp(-((points - points[3000]) ** 2).sum(1) / 0.1)[:, None] * points
    set_coordinates(shape, points)
    bpy.ops.ed.undo_push(message="head")
    space = _view()["area"].spaces.active
    space.show_region_ui = True
    yield 1

    # Esc ends a long run, and leaves everything as it was.
    before = coordinates(shape)
    SEEN["invoked"] = _invoke("detect", method="perpendicular")
    yield 0.3
    _press("ESC")
    asked = time.monotonic()
    yield from _until(lambda: not bpy.context.window_manager.windows[0].modal_operators)
    SEEN["cancelled_after"] = time.monotonic() - asked
    SEEN["mirror_after_esc"] = shape.symsurf_mirror is not None
    SEEN["same_after_esc"] = bool((coordinates(shape) == before).all())

    # A run that ends by itself, from a window.
    _invoke("detect", method="plane")
    yield from _until(lambda: bpy.data.objects["Head"].symsurf_mirror is not None)
    _invoke("symmetrize")
    yield from _until(lambda: not bpy.context.window_manager.windows[0].modal_operators)
    yield 0.5
    shape = bpy.data.objects["Head"]
    SEEN["moved"] = bool((coordinates(shape) != before).any())
    last = bpy.context.window_manager.operators[-1]
    SEEN["last_operator"] = last.bl_idname

    # The sidebar's tab, which reads the settings of the next run, and those of one operation.
    region = next(each for each in _view()["area"].regions if each.type == "UI")
    region.active_panel_category = "Symmetry"
    with bpy.context.temp_override(**_view()):
        bpy.ops.view3d.view_axis(type="FRONT", align_active=True)
        bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITRIGHT")
        bpy.ops.view3d.view_all()
    region.tag_redraw()
    yield 1
    window = bpy.context.window_manager.windows[0]
    for kind, value, x, y in (*OPENING, ("MOUSEMOVE", "NOTHING", 300, 100)):
        window.event_simulate(type=kind, value=value, x=x, y=y)
        yield 0.5
    # Blender's own screenshots are black where no graphics card draws.
    subprocess.run(["import", "-window", "root", f"{PICTURES}/blender-window.png"], check=False)
    _invoke("asymmetry")
    yield from _until(lambda: not bpy.context.window_manager.windows[0].modal_operators)

    # Undo takes one step for each.
    for _ in range(2):
        with bpy.context.temp_override(**_view()):
            bpy.ops.ed.undo()
        yield 0.5
    SEEN["same_after_undo"] = bool((coordinates(bpy.data.objects["Head"]) == before).all())


def _run(steps):
    try:
        return next(steps)
    except StopIteration:
        pass
    except Exception:  # noqa: BLE001  # whoever started this reads it
        SEEN["error"] = traceback.format_exc()
    print(json.dumps(SEEN), flush=True)
    os._exit("error" in SEEN)


STEPS = _steps()
bpy.app.timers.register(lambda: _run(STEPS), first_interval=1, persistent=True)
