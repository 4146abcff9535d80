"""From the zip to an exactly symmetric scan with its texture coordinates: prints how long that took, by the
clock and of the processor, and what came out. Usage: python from_zip.py ZIP."""

import json
import os
import sys
import time

started = time.monotonic()

import bpy
import numpy as np
from heads import coordinates, dented, head, uv

AROUND, UP = 500, 200


def _processor_seconds():
    """Of this process, all its threads, and of those that it has started, such as the installer."""
    return sum(os.times()[:4])


made, made_cpu = time.monotonic(), _processor_seconds()
shape, _ = head(AROUND, UP)
dented(shape, depth=1e-4)
before = uv(shape)
taken = time.monotonic() - made  # making the scan is no part of it
taken_cpu = _processor_seconds() - made_cpu

bpy.ops.extensions.package_install_files(
    filepath=sys.argv[1], repo="user_default", enable_on_install=True
)
installed = time.monotonic()
bpy.ops.symsurf.align()
bpy.ops.symsurf.detect(method="plane")
bpy.ops.symsurf.symmetrize(triangles="mirrored")
seconds = time.monotonic() - started - taken
processor_seconds = _processor_seconds() - taken_cpu

points = coordinates(shape)
normal, offset = json.loads(shape.symsurf_mirror["symsurf_mirror"])["numbers"].values()
images = points - 2 * (points @ np.array(normal) + offset)[:, None] * np.array(normal)
partner = np.empty(len(points), np.int32)
shape.data.attributes["symmetrize_partner"].data.foreach_get("value", partner)
said = {
    "seconds": seconds,
    "processor_seconds": processor_seconds,
    "of_these_after_installing": time.monotonic() - installed,
    "vertices": AROUND * UP,
    "asymmetry": float(np.abs(images - points[partner]).max()),
    "partners_are_mutual": bool((partner[partner] == np.arange(len(points))).all()),
    "texture": [float(uv(shape).min()), float(uv(shape).max())],
    "quadrilaterals": sum(len(each.vertices) == 4 for each in shape.data.polygons),
    "texture_before": [float(before.min()), float(before.max())],
}
print(json.dumps(said), flush=True)
os._exit(0)
